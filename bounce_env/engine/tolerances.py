"""Every tolerance of the engine, with its unit and what it decides. There is no time tolerance."""

# Lengths: a gap no larger than ULPS_OF_LENGTH units in the last place of the lengths that went into it is a touch.
# Evaluating p0 + (v0 + g t / 2) t and a distance costs about six roundings; the factor leaves room for two of them.
ULPS_OF_LENGTH = 16.0 * 2.0**-52  # (dimensionless, times metres)

# Speeds: closing slower than this share of the ball's speed is no hit. The bounce law rounds the speed along a wall
# by about two units in the last place; without this a ball sent along a wall would hit it for ever.
ULPS_OF_SPEED = 4.0 * 2.0**-52  # (dimensionless, times m/s)

# A speed [m/s] below which nothing moves in any time that a run can last; its inverse would overflow.
STANDING = 1e-290

# An acceleration [m/s^2] below which a flight is straight; its square would underflow.
WEIGHTLESS = 1e-150

# How far into an obstacle a ball may be placed by `reset`, as a share of the scene's extent, before it is an error.
# Within it the ball is moved to the surface: it is what is lost by writing a position down.
START_OVERLAP = 1e-12  # (dimensionless, times metres)

# A search that has advanced this often without finding a hit or passing the horizon stops where it is. Bounded-
# acceleration advancement needs 3 to 10 steps; a ball rolling on a curve (which is contact) would need infinitely many.
SEARCH_STEPS = 500

# Bounces resolved at one instant before the ball is left to the next event (and so to the event budget).
BOUNCES_AT_ONE_INSTANT = 32

# Nearer than this share of its way to a stop, a part may or may not have reached it: the stop's instant decides.
UNSURE = 2.0**-40
