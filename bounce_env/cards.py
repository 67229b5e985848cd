"""The games as Gymnasium environments; the docstring of each class is its card."""

from bounce_env.env import BounceEnv
from bounce_env.games.options import PaddleOptions, PinballOptions, WallsOptions
from bounce_env.games.paddle import PaddleGame
from bounce_env.games.pinball import PinballGame
from bounce_env.games.walls import WallsGame


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

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), 84 x 84
    where no size is given. One frame does not tell how fast the ball is: stack some, or ask for a `trail`.

    Levels: with `num_levels` each episode is played on one of so many levels, from `start_level` on, which its seed
    chooses; 0 stands for all of the 2^31. A level is a number from which follows where its bumpers are: anywhere in the
    upper half of the field, with gaps that the ball passes; from level 10 on that on a rail moves, at 0.1 to 0.4 m/s.
    Train on some, such as `num_levels=200`, and measure on others: `num_levels=0, start_level=1_000_000`.

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
    one), `trail` (0.0; seconds of the ball's way, bounces included, that a frame shows, fading), `show_bounces` (False;
    whether `render` shows, after a step with bounces, the last of them in place of the step's end). A vector env also
    takes `num_envs`, `max_episode_steps`, `num_threads` (1), `autoreset_mode` (NEXT_STEP), `copy` (True).

    Versions: v0, first release.
    """

    game_type = PaddleGame
    options_type = PaddleOptions


class PinballEnv(BounceEnv):
    """Three balls on a pinball table with two flippers, three bumpers, two slingshots, a bank of targets, and lanes.

    A table of 0.514 x 1.067 m, as steep as a real one (1.11 m/s^2 along it), a ball of 13.5 mm radius, at most 4 m/s
    fast. Flippers turn by 52 degrees, up in 25 ms and down in 50. Outlanes of 32 mm at both sides and a gap of 45 mm
    between the flippers' tips lead to the drain. The plunger fires by itself, and no step is spent until the ball has
    left its lane. The physics has no time step: every bounce happens at its exact instant.

    Actions, every `frame_skip` / 60 s:

    | `action` | space | meaning |
    | --- | --- | --- |
    | "discrete" | Discrete(4) | buttons: 0 none, 1 left, 2 right, 3 both; with `nudge` (6): 4 left, 5 right |
    | "buttons" | MultiBinary(2) | left, right; with `nudge` MultiBinary(4): left, right, nudge left, nudge right |

    A button that is held holds its flipper up. One that is let go does not act for 0.3 s: who hammers the buttons is
    not ready when the ball comes. A nudge adds 0.25 m/s to its side and 0.15 m/s up the table to the velocity of the
    ball, at most every 0.25 s, and 1 to the tilt meter, which falls by 0.5 a second: at 3 the table is tilted, and
    until that ball is lost the flippers are dead, no points are given and no ball is given back.

    Points, times the multiplier (`score` is their sum):

    | what | points |
    | --- | --- |
    | bumper, slingshot | 50, 10 for a hit; none after 20 of these hits without a flipper's touch |
    | target | 250 if it is lit; it then goes out |
    | the last target of the bank | 1000 more; all are lit again, and the multiplier grows by 1, at most to 5 |
    | rollover lane | 100 if it is not lit; it then lights up |
    | the last lane | 500 more; all go out again |

    The multiplier falls back to 1 with each new ball; targets and lanes stay as they are.

    Observation, float32, nothing clipped; n numbers each for what the table has n of:

    | what | range |
    | --- | --- |
    | ball x, y: left and bottom of the table -1, right and top 1 | [-1, 1] |
    | ball velocity x, y, in m/s | +-sqrt(max_speed^2 + 2 g H), about 4.3 |
    | each flipper: 0 down, 1 up (left, right) | [0, 1] |
    | balls left, this one included, over `balls` | [0, 1] |
    | time for which a lost ball is still given back, over 5 s | [0, 1] |
    | time that the ball has been at the flippers, over 2 s; 1: they are released until it leaves | [0, 1] |
    | multiplier over 5 | [0, 1] |
    | hits of bumpers and slingshots since a flipper's touch, over 20 | [0, 1] |
    | time without points or a touch of a flipper, over 10 s | [0, 1] |
    | time until each button acts again, over 0.3 s (left, right) | [0, 1] |
    | each target (3): 1 if it is lit | {0, 1} |
    | each lane (3): 1 if it is lit | {0, 1} |
    | each bumper (3): what is left of its cooldown of 0.1 s | [0, 1] |
    | tilt meter over 3, 1: tilted; time until the next nudge over 0.25 s; only with `nudge` | [0, 1] |
    | each button that is in force, only where actions are sticky | {0, 1} |

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), 84 x 84
    where no size is given. One frame does not tell how fast the ball is (stack some, or ask for a `trail`), and none
    tells what only clocks and counters know: balls left, ball save, hold timer, multiplier, cooldowns, tilt.

    Reward: points / 1000, and -2 for every ball that is lost ("dense"). With `reward="score"` points / 1000 alone.

    Start: the ball in the lane, shot at 1.45 to 2.4 m/s as the episode's seed says for each one. A step in which a ball
    is in the lane lasts until it is in play, and `frame_skip` frames more where it was there from the start. Options of
    `reset`: `position` puts the first ball straight into play, `velocity` says how fast it is.

    End: terminated when the last ball drains; truncated after `time_limit` seconds of play (or, never seen in play,
    when more than 10 000 events fall into one frame: `end_reason` "budget"). A ball that drains within 5 s is given
    back, once. When one has been in the flippers' zone for 2 s, both are released until it has left it
    (`hold_released`). One that for 10 s has neither met a flipper nor earned points is stuck, and is shot again
    (`stuck_freed`).

    Info: each step `score` and `ball` (0 to `balls` - 1). At an episode's end also `end_reason`, `points_bumpers`,
    `points_slingshots`, `points_targets`, `points_rollovers`, `banks`, `touches` (hits of flippers), `flips`, `saves`,
    `stuck_freed`, `hold_released`, `nudges`, `tilts`, `bounces`, `speed_capped` (bounces at the speed limit) and
    `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, a Scene, or a dict of one; "pinball", whose
    file says what a table must have), `action` ("discrete"), `reward` ("dense"), `nudge` (False), `balls` (3),
    `frame_skip` (2, in units of 1/60 s), `repeat_action_probability` (0.0, per 1/60 s), `time_limit` (120.0 s, None for
    none), `obs` ("state", "pixels"), `render_mode` (None, "rgb_array", "human"), `width`, `height` (of a rendered
    frame, pixels), `obs_width`, `obs_height` (of an observed one), `trail` (0.0; seconds of the ball's way, bounces
    included, that a frame shows, fading), `show_bounces` (False; whether `render` shows, after a step with bounces, the
    last of them in place of the step's end). A vector env also takes `num_envs`, `max_episode_steps`, `num_threads`
    (1), `autoreset_mode` (NEXT_STEP), `copy` (True).

    Versions: v0, first release.
    """

    game_type = PinballGame
    options_type = PinballOptions


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

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), 84 x 84
    where no size is given. One frame does not tell how fast the ball is: stack some, or ask for a `trail`.

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
    end an episode sooner), `obs` ("state"), `render_mode` (None, "rgb_array", "human"), `width`, `height` (of a
    rendered frame, pixels), `obs_width`, `obs_height` (of an observed one), `trail` (0.0, seconds of the ball's way
    that frames show), `show_bounces` (False: a frame shows the end of a step; True: the last bounce in it). A vector
    env also takes `num_envs`, `max_episode_steps`, `num_threads` (1), `autoreset_mode` (NEXT_STEP), `copy` (True).

    Versions: v0, first release.
    """

    game_type = WallsGame
    options_type = WallsOptions
