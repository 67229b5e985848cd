"""Every tolerance of the engine, with its unit and what it decides. There is no time tolerance."""

ULP = 2.0**-52  # (dimensionless) unit in the last place

# Lengths: a gap no larger than ULPS_OF_LENGTH units in the last place of the lengths that went into it is a touch.
# Evaluating p0 + (v0 + g t / 2) t and a distance costs about six roundings; the factor leaves room for two of them.
ULPS_OF_LENGTH = 16.0 * ULP  # (dimensionless, times metres)

# Speeds: closing slower than this share of the ball's speed is no hit. The bounce law rounds the speed along a wall
# by about two units in the last place; without this a ball sent along a wall would hit it for ever.
ULPS_OF_SPEED = 4.0 * ULP  # (dimensionless, times m/s)

# A speed [m/s] below which nothing moves in any time that a run can last; its inverse would overflow.
STANDING = 1e-290

# An acceleration [m/s^2] below which a flight is straight; its square would underflow.
WEIGHTLESS = 1e-150

# How far into an obstacle a ball may be placed by `reset`, as a share of the scene's extent, before it is an error.
# Within it the ball is moved to the surface: it is what is lost by writing a position down.
START_OVERLAP = 1e-12  # (dimensionless, times metres)

# Boxes around what is searched are wider by this share of the scene's extent and of the flight's way: 2^16 times the
# rounding of both, and 16 times what a ball in a corner may be deep in a wall.
BOX_MARGIN = 2.0**-32

# A wall or circle is listed in cells that it misses by this share of the scene's extent: more than a ball touches by.
CELL_MARGIN = 2.0**-20

# The zone of a part is wider than its reach by this share: it keeps rounding of the border from hiding a hit.
ZONE_MARGIN = 0.01

# Bounded-acceleration advancement needs 3 to 10 steps; a search that has taken so many goes on as a polynomial.
SEARCH_STEPS = 24

# A ball that a search has brought nearer than this share of its reach to a turning part has come to it.
SEARCH_ENDS = 1e-9

# Bounces of a ball in one event; more of them at that instant are left to the next one (and so to the event budget).
# In a corner there are as many as its angle allows and these, but never more than so many besides.
BOUNCES_AT_ONE_EVENT = 32
BOUNCES_AT_ONE_INSTANT = 4096

# A ball that has hit others so often (and 4 times more for each two balls), while it has not come further than this
# share of the scene's extent, has no room: to and fro in a gap of less than 4e-9 of it, or thrown at each other again
# and again from next to no distance. Its hits have no rebound any more.
MEETINGS_WITHOUT_ROOM = 256
ROOM_TO_MEET = 2.0**-20

# Of balls that lie on each other, closing slower than this share of sqrt(gravity times radius) is no hit.
SLOW_HIT = 0.03

# Balls nearer than this share of the scene's extent touch when a cluster of them is resolved: forces taken as constant
# for a while let gaps open or close by a part of it.
CLUSTER_GAP = 2.0**-31

# A contact of which others leave no more than this share free depends on them: forces would be 10^5 times the weight.
DEPENDENT = 2.0**-36

# Nearer than this share of its way to a stop, a part may or may not have reached it: the stop's instant decides.
UNSURE = 2.0**-40

# A bracketed root is found in 5 to 10 steps of Newton; where they leave the bracket, halving it needs up to this many.
BRACKETING_STEPS = 100

# Gravity presses a ball on a surface when its share along the normal is larger than this: less is the rounding of the
# directions of both.
PRESSING = 2.0**-40

# With a surface that turns or stretches a contact has no closed form. Its smallest rebound is this share of
# sqrt(acceleration times size): of the speed at which a ball would let go of it.
SMALLEST_REBOUND = 0.01

# A ball between several surfaces is taken to have come to rest when it rises no more than so many tolerances of length.
CORNER = 64.0

# A ball that has bounced so many times in a row, each time after a way of no more than CORNER tolerances, is between
# surfaces that leave it no room: it touches all that are so near.
BOUNCES_WITHOUT_ROOM = 1024

# A ball that a part strikes is crushed where what is nearer to it than this share of the scene's extent leaves it no
# velocity to get away: 6e-5 of it, a tenth of a millimetre on a table.
CLEARANCE = 2.0**-14
FASTEST_ESCAPE = 64.0  # no ball is squeezed out faster than so many times the fastest surface, or than the cap

# Normals that carry a resting ball may miss the direction of gravity by this much.
ALIGNED = 1e-9
