"""Bounce/Paddle: keep the ball in play with a paddle, and send it into the bumpers."""

from bounce_env.envs.base import BounceEnv
from bounce_env.envs.vector import vector_env_of
from bounce_env.games.paddle.game import PaddleGame


class PaddleEnv(BounceEnv):
    """Keep the ball in play with a paddle, and send it into the bumpers.

    A field of 1.0 x 1.4 m under a gravity of 1.5 m/s^2: walls to the sides and above, a drain below, four bumpers that
    speed the ball up (b > 1, at most 3 m/s), and a paddle with round ends above the drain. The paddle's f < 1: its
    motion drags the ball along, so that a player can aim. It kicks whatever hits it, so that no ball dies on it. The
    physics has no time step: every bounce happens at its exact instant.

    Actions, every `frame_skip` / 60 s:

    | `action` | space | meaning |
    | --- | --- | --- |
    | "continuous" | Box(-1, 1, (1,), float32) | speed of the paddle, in units of 1.5 m/s; clipped, NaN is an error |
    | "discrete" | Discrete(3) | 0 left, 1 stay, 2 right, at full speed |

    Observation, float32, nothing clipped:

    | index | what | range |
    | --- | --- | --- |
    | 0 | ball x: left wall -1, right wall 1 | [-1, 1] |
    | 1 | ball y: drain -1, top 1 | [-1, 1] |
    | 2, 3 | ball velocity x, y, in units of 2 m/s | +-sqrt(max_speed^2 + 2 g H) / 2, about 1.8 |
    | 4 | paddle: left stop -1, right stop 1 | [-1, 1] |
    | 5 ... | of each bumper x, y, as the ball's; see below | [-1, 1] |
    | last | what the paddle does now, only where actions are sticky | [-1, 1] |

    Bumpers are observed where they are not always in the same places: with levels all of them, otherwise those on
    rails. Of one on a rail there are eight numbers: x, y now, velocity x, y in units of 0.4 m/s, and x, y of both ends
    of its rail. The built-in levels have 14 in all: three bumpers of two, one of eight.

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), or with
    `grayscale` (obs_height, obs_width, 1), 84 x 84 where no size is given. One frame does not tell how fast the ball
    is: stack some, or ask for a `trail`.

    Levels: with `num_levels` each episode is played on one of so many levels, from `start_level` on, which its seed
    chooses; 0 stands for all from there on, up to the last of the 2^31. A level is a number from which follows where
    its bumpers are: anywhere in the upper half of the field, with gaps that the ball passes; from level 10 on that on a
    rail moves, at 0.1 to 0.4 m/s. Train on some, such as `num_levels=200`, and measure on others: `num_levels=0,
    start_level=1_000_000`.

    Reward: 1 for each hit of a bumper ("score"). Nothing for survival. With `reward="dense"` besides, in every step,
    gamma Phi(s') - Phi(s), where Phi = -(distance along the rail from the paddle's middle to the ball) / (diagonal of
    the field), and 0 when the ball is lost: potential-based shaping, under which the best policy stays the best for an
    agent that discounts by the same `gamma`.

    Start: the ball at 40 % of the field's height, x uniform over the middle 60 % of its width, 1.5 m/s at 30 to 150
    degrees, all from the episode's seed; the paddle in the middle. Options of `reset`: `position`, `velocity`,
    `snapshot`, and with levels `level`, which `position` needs.

    End: terminated when the ball drains; truncated after `time_limit` seconds of play (or, never seen in play, when
    more than 10 000 events fall into one step: `end_reason` "budget").

    Info: each step `score` (bumpers hit so far), `ball` (0) and, with levels, `level`. At an episode's end also
    `end_reason`, `points_bumpers`, `bounces`, `touches` (hits of the paddle), `speed_capped` (bounces at the limit) and
    `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, a Scene, or a dict of one; None: "paddle", or
    with levels "paddle_levels"), `num_levels` (None: no levels), `start_level` (0), `action` ("continuous"), `reward`
    ("score"), `gamma` (0.99, of the dense reward), `frame_skip` (2, in units of 1/60 s), `repeat_action_probability`
    (0.0, per 1/60 s), `time_limit` (120.0 s, None for none), `obs` ("state", "pixels"), `render_mode` (None,
    "rgb_array", "human"), `width`, `height` (of a rendered frame, pixels), `obs_width`, `obs_height` (of an observed
    one), `grayscale` (False), `trail` (0.0; seconds of the ball's way, bounces included, that a frame shows, fading),
    `show_bounces` (False; whether `render` shows, after a step with bounces, the last of them in place of the step's
    end), `record_events` (False; whether `replay` has what happens). A vector env also takes `num_envs`,
    `max_episode_steps`, `num_threads` (1), `autoreset_mode` ("NEXT_STEP", "SAME_STEP", "DISABLED"), `copy` (True),
    `info` ("all"; "ends", "none").

    Versions: v0, first release. What the engine does: docs/physics.md.
    """

    game_type = PaddleGame


PaddleVectorEnv = vector_env_of(PaddleEnv)
