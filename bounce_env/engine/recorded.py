"""What was recorded of a world: its ledger, and the paths that balls and parts took between its events."""

from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.memory.records import CARRIED_ALONG, MOMENT, ON_CURVE, OUT
from bounce_env.engine.memory.state import Recording, State, going_on
from bounce_env.engine.motion.carried import Carried, carried_after
from bounce_env.engine.motion.curve_slide import CurveSlide, curve_slide_after
from bounce_env.engine.motion.flight import Flight, flight_place_after
from bounce_env.scene import Flipper, Scene, Wall

_slide_after, _carried_after = from_python(curve_slide_after), from_python(carried_after)
_place_after = from_python(flight_place_after)


class BallPath(NamedTuple):
    """From `begin` on [s] a ball goes on from (x, y) [m] with (vx, vy) [m/s] under (ax, ay) [m/s^2].

    bent: what its path is instead, where it slides on a curve or two surfaces carry it. out: it has crossed a drain,
    and stays there.
    """

    begin: float
    x: float
    y: float
    vx: float
    vy: float
    ax: float
    ay: float
    out: bool = False
    bent: CurveSlide | Carried | None = None

    def at(self, time: float) -> tuple[float, float]:
        """Return where the ball is at an instant [s]: x, y [m]."""
        t = time - self.begin
        if self.out:
            return self.x, self.y
        if isinstance(self.bent, CurveSlide):
            return _slide_after(self.bent, t)[:2]
        if self.bent is not None:
            return _carried_after(self.bent, t)[:2]
        return _place_after(Flight(self.x, self.y, self.vx, self.vy, self.ax, self.ay), t)


class PartPath(NamedTuple):
    """From `begin` on [s] each number of a part changes at its rate: see `Recorded.parts`."""

    begin: float
    place: tuple[float, ...]
    rate: tuple[float, ...]

    def at(self, time: float) -> tuple[float, ...]:
        """Return the numbers at an instant."""
        return tuple(p + r * (time - self.begin) for p, r in zip(self.place, self.rate, strict=True))


class Change(NamedTuple):
    """At `time` [s] an element's field becomes another: `disabled`, or `center` of a target that is put elsewhere."""

    time: float
    element: int
    field: str
    value: Any


class Recorded(NamedTuple):
    """A run of a world from its reset on: what docs/replay.md makes a page of.

    ledger: all events, see `World.advance`. balls: the paths of each, one after the other. parts: those of each moving
    part, in the order of the scene: of a paddle or a bumper the centre x, y [m]; of a flipper its angle [rad]; of a
    dragged wall its ends x, y, x, y [m]. changes: of elements, in the order of time. end: up to when it goes [s].
    """

    scene: Scene
    ledger: npt.NDArray[Any]
    balls: tuple[tuple[BallPath, ...], ...]
    parts: tuple[tuple[PartPath, ...], ...]
    changes: tuple[Change, ...]
    end: float


def recorded_of(scene: Scene, state: State, pages: Sequence[Recording], world: int, end: float) -> Recorded:
    """Return what the pages of a recorded world of `state` hold, up to a time."""
    ledger = np.concatenate([page.ledger for page in pages] or [state.recording.ledger[:0]])
    balls, parts = range(state.balls.shape[1]), range(len(scene.parts))
    return Recorded(
        scene,
        ledger,
        tuple(tuple(_changes(_ball_path(page, i, k) for page, i in _moments(pages))) for k in balls),
        tuple(
            tuple(_changes(_part_path(scene, state, world, page, i, m) for page, i in _moments(pages))) for m in parts
        ),
        tuple(_switched(pages)),
        end,
    )


def with_present_moment(page: Recording, state: State, world: int) -> Recording:
    """Return a page with the moment now at its end: balls and parts may have been moved since the last event."""
    clock = state.worlds[world]
    moment = np.array([(clock["time_hi"], clock["time_lo"], len(page.ledger))], MOMENT)
    now = [moment, *(None if array is None else array[world : world + 1] for array in going_on(state))]
    kept: list[Any] = [
        None if array is None else np.concatenate([array, last]) for array, last in zip(page[2:], now, strict=True)
    ]
    return Recording(page.head, page.ledger, *kept)


def _moments(pages: Sequence[Recording]) -> Iterator[tuple[Recording, int]]:
    return ((page, i) for page in pages for i in range(len(page.moments)))


def _changes(paths: Iterator[Any]) -> Iterator[Any]:
    """Return paths without repetitions, and without those that are over as soon as they begin."""
    last: Any = None
    for path in paths:
        if last is not None and path != last and path.begin > last.begin:
            yield last
        last = path
    if last is not None:
        yield last


def _switched(pages: Sequence[Recording]) -> Iterator[Change]:
    """Return what was switched off, and on again."""
    last: Any = None
    for page, i in _moments(pages):
        if page.disabled is None:
            return
        now = page.disabled[i]
        for element in np.flatnonzero(now if last is None else now != last).tolist():
            yield Change(float(page.moments[i]["hi"]), element, "disabled", bool(now[element]))
        last = now


def _ball_path(page: Recording, i: int, k: int) -> BallPath:
    b = _row(page.balls[i, k])
    begin, out = b["hi"] + b["lo"], b["status"] == OUT
    bent: CurveSlide | Carried | None = None
    if b["contact"] == ON_CURVE:
        bent = CurveSlide(*itemgetter(*CurveSlide._fields)(_row(page.curve_slides[i, k])))
    elif b["contact"] == CARRIED_ALONG:
        bent = Carried(*itemgetter(*Carried._fields)(_row(page.carried[i, k])))
    return BallPath(begin, b["x"], b["y"], b["vx"], b["vy"], b["ax"], b["ay"], out, None if out else bent)


def _part_path(scene: Scene, state: State, world: int, page: Recording, i: int, m: int) -> PartPath:
    part, motion, shape = scene.parts[m][1], _row(page.motions[i, m]), state.parts[state.worlds[world].scene, m]
    begin, offset, velocity = motion["hi"] + motion["lo"], motion["offset"], motion["velocity"]
    if isinstance(part, Wall):
        ends = _row(page.ends[i, m])
        places = tuple(ends[name] for name in ("x0", "y0", "x1", "y1"))
        return PartPath(begin, places, tuple(ends[f"v{name}"] for name in ("x0", "y0", "x1", "y1")))
    if isinstance(part, Flipper):
        turn = 1.0 if part.active_angle > part.rest_angle else -1.0
        return PartPath(begin, (part.rest_angle + turn * offset,), (turn * velocity,))
    ux, uy = float(shape.ux), float(shape.uy)
    place = (float(shape.x) + ux * offset, float(shape.y) + uy * offset)
    return PartPath(begin, place, (ux * velocity, uy * velocity))


def _row(record: Any) -> dict[str, Any]:
    return dict(zip(record.dtype.names, record.item(), strict=True))
