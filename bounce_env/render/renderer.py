"""The still scene drawn once; each frame copies it and draws what moves or was just struck."""

import math
from collections.abc import Collection, Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from bounce_env.render.frame_content import Picture
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.render.outline import view_box
from bounce_env.render.projection import Projection
from bounce_env.render.shapes import ball_look, part_look, rail_look, solid_looks, still_look, target_look, trail_look
from bounce_env.scene import Field, Scene, Sensor


class Renderer:
    """Draws one scene at one size, without a display.

    scene: what to draw. width, height: of a frame in pixels; see `Projection.fit` for what is left out.
    targets: the elements, circular sensors, that are drawn as targets, where each picture says. hidden: elements that
    are not drawn.
    Raises ValueError for a bad size, `gymnasium.error.DependencyNotInstalled` without pygame.

    projection: from metres to the frame's pixels, and back.
    """

    def __init__(
        self,
        scene: Scene,
        width: int | None = None,
        height: int | None = None,
        *,
        targets: Sequence[int] = (),
        hidden: Collection[int] = (),
    ) -> None:
        load_pygame()
        from bounce_env.render import painter  # noqa: PLC0415 (pygame is an extra: only who draws needs it)

        self.projection = Projection.fit(view_box(scene), width, height)
        size = (self.projection.width, self.projection.height)
        parts = dict(scene.parts)
        unseen = {*parts, *targets, *hidden}
        still = {i: e for i, e in enumerate(scene.elements) if i not in unseen}
        rails = [look for part in parts.values() if (look := rail_look(part, self.projection))]
        beneath = sorted(still.values(), key=lambda e: not isinstance(e, Field))
        at_rest = [still_look(e, scene, self.projection, lit=False) for e in beneath]
        self._painter = painter
        self._elements = len(scene.elements)
        solids = solid_looks(scene, self.projection, hidden)
        self._background = painter.still_picture(*size, [*solids, *rails, *at_rest])
        self._flashes = {i: painter.Overlay(still_look(e, scene, self.projection, lit=True)) for i, e in still.items()}
        self._parts = {
            i: tuple(
                painter.Turned(partial(part_look, e, scene=scene, projection=self.projection, lit=lit))
                for lit in (False, True)
            )
            for i, e in parts.items()
        }
        self._targets = [painter.Sprite(target_look(scene.elements[i], self.projection)) for i in targets]
        self._ball = painter.Sprite(ball_look(scene, self.projection))
        self._trail = painter.Trail(partial(trail_look, scene, self.projection))
        blank = painter.still_picture(*size, [])
        inked = np.abs(self._background.astype(np.int16) - blank).sum(axis=2) > 0
        self._label = painter.Label(*_label_place(scene, self.projection, inked))

    @property
    def background(self) -> npt.NDArray[np.uint8]:
        """What stands, at rest, (height, width, 3)."""
        return self._background

    def flashes(self) -> dict[int, tuple[int, int, npt.NDArray[np.uint8]]]:
        """Return what lies over each element that stands when it lights up: left, top, and the picture.

        The picture is (height, width, 4), colours multiplied by their opacity, which is the last of the four.
        """
        return {i: flash.picture() for i, flash in self._flashes.items()}

    def frame(self, picture: Picture) -> npt.NDArray[np.uint8]:
        """Return a new C-contiguous array of RGB pixels, shape (height, width, 3), rows from the top.

        The same picture gives the same bytes. Raises ValueError, and draws nothing, if a field of the
        picture has a wrong shape or holds what is not finite.
        """
        balls = self.projection.to_pixels(_points("balls", picture.balls))
        cores = self.projection.to_pixels(_ends("cores", picture.cores, len(self._parts)))
        centers = self.projection.to_pixels(_points("targets", picture.targets))
        if len(centers) != len(self._targets):
            raise ValueError(f"targets: must be {len(self._targets)} centres, not {len(centers)}")
        alive = _flags("alive", picture.alive, len(balls), missing=True)
        hits = _flags("hits", picture.hits, self._elements, missing=False)
        hits |= _flags("lit", picture.lit, self._elements, missing=False)
        way = _faded("trail", picture.trail)
        text = None if picture.score is None else _printed(picture.score)

        pixels = self._background.copy()
        target = self._painter.surface_of(pixels)
        for sprite, (x, y) in zip(self._targets, centers.tolist(), strict=True):
            sprite.draw(target, x, y)
        for i in np.flatnonzero(hits).tolist():
            if i in self._flashes:
                self._flashes[i].draw(target)
        if text is not None:
            self._label.draw(target, text)
        if len(way):
            self._trail.draw(target, self.projection.to_pixels(way[:, :2]), way[:, 2])
        for (i, (calm, lit)), start, end in zip(self._parts.items(), *cores.reshape(2, -1, 2).tolist(), strict=True):
            (lit if hits[i] else calm).draw(target, start, end)
        for x, y in balls[alive].tolist():
            self._ball.draw(target, x, y)
        return pixels


def _label_place(scene: Scene, projection: Projection, inked: npt.NDArray[np.bool_]) -> tuple[int, int, int, int]:
    """Middle, top, width of the room around the middle, and text size, in pixels: at the top, inside of what bounces
    the ball.

    The uppermost place where a score of five digits, in the middle of the field or else as near to it as it can be,
    covers nothing that is `inked`; the field's upper edge if there is none. Sensors do not count as the inside, for a
    drain may be wider than the field, nor do regions of acceleration.
    """
    boxes = [e.bounds for e in scene.elements if not isinstance(e, Sensor | Field)] or [scene.bounds]
    x_min, y_min, x_max, y_max = np.transpose(boxes)
    corners = [(x_min.min(), y_max.max()), (x_max.max(), y_min.min())]
    (left, top), (right, bottom) = projection.to_pixels(corners).round().astype(int).tolist()
    inset = max(2, round(0.025 * min(projection.width, projection.height)))
    size = max(11, round(0.075 * (bottom - top)))
    left, top, right = left + inset, top + inset // 2, right - inset
    middle = (left + right) // 2
    width, height = round(2.3 * size), round(0.8 * size)
    for y in range(top, top + round(0.2 * (bottom - top)) - height):
        blocked = np.logical_or.reduce(inked[y : y + height, left:right], axis=0)
        free = np.convolve(blocked, np.ones(width, int), "valid") == 0 if blocked.size >= width else np.zeros(0, bool)
        if free.any():
            starts = np.flatnonzero(free)
            x = int(starts[np.abs(starts + width // 2 + left - middle).argmin()]) + width // 2
            walls = np.flatnonzero(blocked)
            before, after = walls[walls < x], walls[walls > x]
            reach = min(x - int(before.max(initial=-1)), int(after.min(initial=blocked.size)) - x) - 1
            return left + x, y, 2 * reach, size
    return middle, top, max(1, right - left), size


def _points(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    points = np.asarray(value, dtype=np.float64)
    if points.size == 0:
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"{name} has shape {points.shape}: must be (k, 2), centres in metres")
    return _finite(name, points)


def _ends(name: str, value: npt.ArrayLike, count: int) -> npt.NDArray[np.float64]:
    """First all the starts, then all the ends, (2 count, 2)."""
    rows = np.asarray(value, dtype=np.float64)
    if rows.size == 0:
        rows = rows.reshape(0, 4)
    if rows.shape != (count, 4):
        raise ValueError(f"{name} has shape {rows.shape}: must be ({count}, 4), x, y, x, y in metres")
    return np.concatenate([_finite(name, rows)[:, :2], rows[:, 2:]])


def _faded(name: str, value: npt.ArrayLike | None) -> npt.NDArray[np.float64]:
    rows = np.asarray(() if value is None else value, dtype=np.float64)
    if rows.size == 0:
        rows = rows.reshape(0, 3)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError(f"{name} has shape {rows.shape}: must be (n, 3), x, y in metres and freshness from 0 to 1")
    if not ((rows[:, 2] >= 0.0) & (rows[:, 2] <= 1.0)).all():
        raise ValueError(f"{name} = {rows.tolist()}: freshness must be from 0 to 1")
    return _finite(name, rows)


def _finite(name: str, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    if not np.isfinite(points).all():
        raise ValueError(f"{name} = {points.tolist()}: must be finite, metres")
    return points


def _flags(name: str, value: npt.ArrayLike | None, count: int, *, missing: bool) -> npt.NDArray[np.bool_]:
    if value is None:
        return np.full(count, missing)
    flags = np.asarray(value).astype(np.bool_)
    if flags.shape != (count,):
        raise ValueError(f"{name} has shape {flags.shape}: must be ({count},)")
    return flags


def _printed(score: float) -> str:
    if not math.isfinite(score):
        raise ValueError(f"score = {score!r}: must be None or finite")
    decimals = 0 if score == round(score) else 2
    return f"{float(score):z,.{decimals}f}"
