"""Bounce/Pinball: three balls on a pinball table with two flippers."""

from bounce_env.envs.base import BounceEnv
from bounce_env.envs.vector import vector_env_of
from bounce_env.games.pinball.game import PinballGame


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

    Observation, float32, nothing clipped; the indices are those of the built-in table (of one with other numbers of
    flippers, targets, lanes or bumpers, `env.unwrapped.observed` says what is where):

    | index | what | range |
    | --- | --- | --- |
    | 0, 1 | ball x, y: left and bottom of the table -1, right and top 1 | [-1, 1] |
    | 2, 3 | ball velocity x, y, in m/s | +-sqrt(max_speed^2 + 2 g H), about 4.3 |
    | 4, 5 | each flipper: 0 down, 1 up (left, right) | [0, 1] |
    | 6 | balls left, this one included, over `balls` | [0, 1] |
    | 7 | time for which a lost ball is still given back, over 5 s | [0, 1] |
    | 8 | time that the ball has been at the flippers, over 2 s; 1: they are released until it leaves | [0, 1] |
    | 9 | multiplier over 5 | [0, 1] |
    | 10 | hits of bumpers and slingshots since a flipper's touch, over 20 | [0, 1] |
    | 11 | time without points or a touch of a flipper, over 10 s | [0, 1] |
    | 12, 13 | time until each button acts again, over 0.3 s (left, right) | [0, 1] |
    | 14 to 16 | each target: 1 if it is lit | {0, 1} |
    | 17 to 19 | each lane: 1 if it is lit | {0, 1} |
    | 20 to 22 | each bumper: what is left of its cooldown of 0.1 s | [0, 1] |
    | 23, 24 | tilt meter over 3, 1: tilted; time until the next nudge over 0.25 s; only with `nudge` | [0, 1] |
    | last | each button that is in force, only where actions are sticky | {0, 1} |

    With `obs="pixels"` it is a frame as `render` gives it, but for the score: uint8 (obs_height, obs_width, 3), or with
    `grayscale` (obs_height, obs_width, 1), 84 x 84 where no size is given. One frame does not tell how fast the ball is
    (stack some, or ask for a `trail`), and none tells what only clocks and counters know: balls left, ball save, hold
    timer, multiplier, cooldowns, tilt.

    Reward: points / 1000, and -2 for every ball that is lost ("dense"). With `reward="score"` points / 1000 alone.

    Start: the ball in the lane, shot at 1.45 to 2.4 m/s as the episode's seed says for each one. Frames in which a ball
    is on its way out of the lane do not count as a step's: a step lasts `frame_skip` frames of play, and until no ball
    is in the lane. Options of `reset`: `position` puts the first ball straight into play, `velocity` says how fast it
    is.

    End: terminated when the last ball drains; truncated after `time_limit` seconds of play (or, never seen in play,
    when more than 10 000 events fall into one frame: `end_reason` "budget"). A ball that drains within 5 s after it
    came into play is given back, each ball once. When one has been in the flippers' zone for 2 s, both are released
    until it has left it (`hold_released`). One that for 10 s has neither met a flipper nor earned points is stuck, and
    is shot again (`stuck_freed`).

    Info: each step `score` and `ball` (0 to `balls` - 1). At an episode's end also `end_reason`, `points_bumpers`,
    `points_slingshots`, `points_targets`, `points_rollovers`, `banks`, `touches` (hits of flippers), `flips`, `saves`,
    `stuck_freed`, `hold_released`, `nudges`, `tilts`, `bounces`, `speed_capped` (bounces at the speed limit) and
    `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, a Scene, or a dict of one; "pinball", whose
    file says what a table must have), `action` ("discrete"), `reward` ("dense"), `nudge` (False), `balls` (3),
    `frame_skip` (2, in units of 1/60 s), `repeat_action_probability` (0.0, per 1/60 s), `time_limit` (120.0 s, None for
    none), `obs` ("state", "pixels"), `render_mode` (None, "rgb_array", "human"), `width`, `height` (of a rendered
    frame, pixels), `obs_width`, `obs_height` (of an observed one), `grayscale` (False), `trail` (0.0; seconds of the
    ball's way, bounces included, that a frame shows, fading), `show_bounces` (False; whether `render` shows, after a
    step with bounces, the last of them in place of the step's end), `record_events` (False; whether `replay` has what
    happens). A vector env also takes `num_envs`, `max_episode_steps`, `num_threads` (1), `autoreset_mode` ("NEXT_STEP",
    "SAME_STEP", "DISABLED"), `copy` (True), `info` ("all"; "ends", "none").

    Versions: v0, first release. What the engine does: docs/physics.md.
    """

    game_type = PinballGame


PinballVectorEnv = vector_env_of(PinballEnv)
