"""All cases, of standing scenes and of moving ones."""

from moving_flippers import FLIPPERS
from moving_paddles import PADDLES
from moving_walls import WALLS
from standing_commands import COMMANDS
from standing_corners import CORNERS
from standing_corridors import CORRIDORS
from standing_curves import CURVES
from standing_drops import DROPS
from standing_extremes import EXTREMES
from standing_fields import FIELDS
from standing_holds import HOLDS
from standing_hollows import HOLLOWS
from standing_kicks import KICKS
from standing_passages import PASSAGES
from standing_rooms import ROOMS
from standing_slides import SLIDES
from standing_starts import STARTS
from standing_tails import TAILS
from standing_wedges import WEDGES

CASES = [
    *DROPS, *HOLDS, *SLIDES, *CORRIDORS, *CORNERS, *WEDGES, *CURVES, *HOLLOWS, *STARTS, *EXTREMES, *PASSAGES, *FIELDS,
    *KICKS, *COMMANDS, *ROOMS, *TAILS, *PADDLES, *FLIPPERS, *WALLS,
]  # fmt: skip
