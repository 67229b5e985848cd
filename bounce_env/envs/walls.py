"""Bounce/Walls: bring each ball to its target with a wall that is dragged by its ends."""

from bounce_env.envs.base import BounceEnv
from bounce_env.envs.vector import vector_env_of
from bounce_env.games.walls.game import WallsGame


class WallsEnv(BounceEnv):
    """Bring each of five balls to its target with a wall whose two ends you drag.

    A field of 1 x 1 m under a gravity of 2 m/s^2: walls to the sides and above, a drain below, and between them six
    standing walls, ledges and a roof. Balls of 20 mm radius fall from above. The player's wall is a guide and not a
    bat (b = 0.9), 0.1 to 0.4 m long. The target is a circle of 0.06 m radius: a ball is there when its centre enters
    it, at that exact instant, as every bounce happens at its own; the physics has no time step.

    Action, every `frame_skip` / 60 s: Box(-1, 1, (4,), float32), the velocities x, y of the wall's first end and x, y
    of its second one, in units of 1 m/s; clipped, NaN is an error. The ends stop at the border of a box, x 0.05 to
    0.95 and y 0.05 to 0.65 m. Where they have come as near to each other as 0.1 m both stop; one that is drawn away
    further than 0.4 m drags the other one along. The wall passes through the standing walls; a ball that it crushes
    against one of them is lost.

    Observation, float32, nothing clipped:

    | index | what | range |
    | --- | --- | --- |
    | 0, 1 | ball x, y: left wall and drain -1, right wall and top 1 | [-1, 1] |
    | 2, 3 | ball velocity x, y, in units of 2 m/s | +-sqrt(max_speed^2 + 2 g H) / 2, about 1.8 |
    | 4, 5, 6, 7 | ends of the wall, x, y, x, y, as the ball's | [-1, 1] |
    | 8, 9 | target x, y, as the ball's | [-1, 1] |
    | 10 | time that the ball has left, over 8 s | [0, 1] |
    | 11 | balls left, this one included, over `balls` | [0, 1] |
    | 12 to 15 | the action in force, only where actions are sticky | [-1, 1] |

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), or with
    `grayscale` (obs_height, obs_width, 1), 84 x 84 where no size is given. One frame does not tell how fast the ball
    is: stack some, or ask for a `trail`.

    Reward: 1 for each target ("sparse"). With `reward="dense"` besides, in every step, gamma Phi(s') - Phi(s), where
    Phi = -(distance from the ball to its target) / (diagonal of the field), and 0 when the last ball has been played:
    potential-based shaping, under which the best policy stays the best for an agent that discounts by the same
    `gamma`. `score` is the sum of targets under both.

    Start: the wall lies at (0.4 to 0.6, 0.15) m. A ball is launched 0.9 m high, x uniform from 0.2 to 0.8 m, at up to
    0.5 m/s to either side. Its target lies uniformly anywhere on the field, but not within 0.25 diagonals of the
    launch nor where the ball gets with the wall left alone: that is tried out when it is launched, and another place
    drawn until it does not. Ball k's launch and target follow from (episode seed, k) alone. Options of `reset`:
    `position` and `velocity` of the first ball, `snapshot`.

    A ball is over when it is in its target, in the drain, crushed, or has been played for 8 s. In the same step the
    next one is launched, and the wall is back where it was at first: each ball is a problem of its own.

    End: terminated when the last ball is over (`end_reason` "all_played"); truncated after `time_limit` seconds of
    play (or, never seen in play, when more than 10 000 events fall into one step: "budget").

    Info: each step `score` (targets so far) and `ball` (0 to `balls` - 1). At an episode's end also `is_success` (a
    bool: more than half of the episode's balls were brought to their targets, 3 of 5), `end_reason`, `points_targets`,
    `drained`, `crushed`, `timed_out` (how many balls ended so), `touches` (hits of the player's wall), `bounces`,
    `speed_capped` (bounces at the speed limit) and `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, a Scene, or a dict of one; "walls", whose file
    says what one must have), `reward` ("sparse"), `gamma` (0.99, of the dense reward), `balls` (5), `frame_skip` (2, in
    units of 1/60 s), `repeat_action_probability` (0.0, per 1/60 s), `time_limit` (90.0 s, None for none; the balls' 8 s
    end an episode sooner), `obs` ("state", "pixels"), `render_mode` (None, "rgb_array", "human"), `width`, `height` (of
    a rendered frame, pixels), `obs_width`, `obs_height` (of an observed one), `grayscale` (False), `trail` (0.0,
    seconds of the ball's way that frames show), `show_bounces` (False: a frame shows the end of a step; True: the last
    bounce in it), `record_events` (False; whether `replay` has what happens). A vector env also takes `num_envs`,
    `max_episode_steps`, `num_threads` (1), `autoreset_mode` ("NEXT_STEP", "SAME_STEP", "DISABLED"), `copy` (True),
    `info` ("all"; "ends", "none").

    Versions: v0, first release. What the engine does: docs/physics.md.
    """

    game_type = WallsGame


WallsVectorEnv = vector_env_of(WallsEnv)
