"""All cases, of standing scenes and of moving ones."""

from tests.stability.moving_flippers import FLIPPERS
from tests.stability.moving_paddles import PADDLES
from tests.stability.moving_walls import WALLS
from tests.stability.standing_commands import COMMANDS
from tests.stability.standing_corners import CORNERS
from tests.stability.standing_corridors import CORRIDORS
from tests.stability.standing_curves import CURVES
from tests.stability.standing_drops import DROPS
from tests.stability.standing_extremes import EXTREMES
from tests.stability.standing_fields import FIELDS
from tests.stability.standing_holds import HOLDS
from tests.stability.standing_hollows import HOLLOWS
from tests.stability.standing_kicks import KICKS
from tests.stability.standing_passages import PASSAGES
from tests.stability.standing_rooms import ROOMS
from tests.stability.standing_slides import SLIDES
from tests.stability.standing_starts import STARTS
from tests.stability.standing_tails import TAILS
from tests.stability.standing_wedges import WEDGES

CASES = [
    *DROPS, *HOLDS, *SLIDES, *CORRIDORS, *CORNERS, *WEDGES, *CURVES, *HOLLOWS, *STARTS, *EXTREMES, *PASSAGES, *FIELDS,
    *KICKS, *COMMANDS, *ROOMS, *TAILS, *PADDLES, *FLIPPERS, *WALLS,
]  # fmt: skip
