"""All cases, of standing scenes and of moving ones."""

from bounce_env.report.stability.cases.commands import COMMANDS
from bounce_env.report.stability.cases.corners import CORNERS
from bounce_env.report.stability.cases.corridors import CORRIDORS
from bounce_env.report.stability.cases.curves import CURVES
from bounce_env.report.stability.cases.dragged_walls import WALLS
from bounce_env.report.stability.cases.drops import DROPS
from bounce_env.report.stability.cases.extremes import EXTREMES
from bounce_env.report.stability.cases.fields import FIELDS
from bounce_env.report.stability.cases.flippers import FLIPPERS
from bounce_env.report.stability.cases.holds import HOLDS
from bounce_env.report.stability.cases.hollows import HOLLOWS
from bounce_env.report.stability.cases.kicks import KICKS
from bounce_env.report.stability.cases.paddles import PADDLES
from bounce_env.report.stability.cases.passages import PASSAGES
from bounce_env.report.stability.cases.rooms import ROOMS
from bounce_env.report.stability.cases.slides import SLIDES
from bounce_env.report.stability.cases.starts import STARTS
from bounce_env.report.stability.cases.tails import TAILS
from bounce_env.report.stability.cases.wedges import WEDGES

CASES = [
    *DROPS, *HOLDS, *SLIDES, *CORRIDORS, *CORNERS, *WEDGES, *CURVES, *HOLLOWS, *STARTS, *EXTREMES, *PASSAGES, *FIELDS,
    *KICKS, *COMMANDS, *ROOMS, *TAILS, *PADDLES, *FLIPPERS, *WALLS,
]  # fmt: skip
