"""Frames for agents, by compiled code: thousands of small pictures in a call.

What stands is taken from a `Renderer`, once; so is the picture of each element that lights up. Balls, parts and targets
are discs and lines with round ends, in rings of one colour each, of which a pixel gets the share that they cover: its
distance from the line tells its colour. The `Renderer` draws all of it eight times larger and scales it down. Beside
its frames of the same size a pixel differs by less than one of 255 shades on average; only on edges it is more.
"""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import function, kernel
from bounce_env.engine.memory.records import Array
from bounce_env.render.renderer import Renderer
from bounce_env.render.shapes import Look, Stroke, ball_look, part_look, target_look
from bounce_env.scene import Scene

# Of red, green and blue in grey, as in ITU-R BT.601, which frames of Atari games are made grey by.
LUMA = (0.299, 0.587, 0.114)

# So many distances a pixel are looked up, and what lies between two of them is interpolated.
_FINENESS = 32


class Scenery(NamedTuple):
    """A scene at one size, as kernels get it. Colours are multiplied by their opacity; c is 3, or 1 of grey."""

    background: Array  # (height, width, c) uint8
    projection: Array  # (3,) pixels a metre; the pixel coordinates x, y of the scene's origin
    flashes: Array  # (elements, 5) int64: left, top, width, height, first row in `flash_pixels`; -1: it is not drawn
    flash_pixels: Array  # (n, c + 1) float64, 0 to 255: colour and opacity
    shades: Array  # (n, c + 1) float64: colour 0 to 255, opacity 0 to 1, by the distance from a line
    ball: Array  # (2,) int64: from which row of `shades` to before which
    targets: Array  # (targets, 2) int64
    parts: Array  # (parts, 5) int64: the element; the shades at rest, and lit


class Seen(NamedTuple):
    """What changes of some worlds."""

    balls: Array  # (worlds, balls, 4) x, y [m], and what else there is
    alive: Array  # (worlds, balls) bool: is drawn
    cores: Array  # (worlds, parts, 4) ends x, y, x, y [m]
    hits: Array  # (worlds, elements) bool: lights up
    targets: Array  # (worlds, targets, 2) centres [m]


def scenery_of(
    scene: Scene, width: int, height: int, *, grey: bool, targets: Sequence[int] = (), hidden: Collection[int] = ()
) -> Scenery:
    """Return a scene as `draw` needs it; arguments as of `Renderer`."""
    renderer = Renderer(scene, width, height, targets=targets, hidden=hidden)
    projection = renderer.projection
    flashes, pixels = np.full((len(scene.elements), 5), -1), [np.zeros((0, 4))]
    for i, (left, top, image) in renderer.flashes().items():
        flashes[i] = left, top, image.shape[1], image.shape[0], sum(map(len, pixels))
        pixels.append(image.reshape(-1, 4).astype(np.float64))
    shades: list[npt.NDArray[np.float64]] = []
    ball = _add_shades(shades, ball_look(scene, projection))
    target_rows = [_add_shades(shades, target_look(scene.elements[i], projection)) for i in targets]
    looks = [
        (i, [part_look(e, (1.0, 0.0), scene, projection, lit=lit) for lit in (False, True)]) for i, e in scene.parts
    ]
    part_rows = [(i, *_add_shades(shades, calm), *_add_shades(shades, lit)) for i, (calm, lit) in looks]
    background = in_grey(renderer.background) if grey else renderer.background
    colours, flat = np.concatenate(shades), np.concatenate(pixels)
    if grey:
        colours, flat = (np.column_stack([rows[:, :3] @ LUMA, rows[:, 3]]) for rows in (colours, flat))
    return Scenery(
        background,
        np.array([projection.scale, projection.left, projection.bottom]),
        flashes,
        np.ascontiguousarray(flat),
        np.ascontiguousarray(colours),
        np.array(ball),
        np.array(target_rows, np.int64).reshape(-1, 2),
        np.array(part_rows, np.int64).reshape(-1, 5),
    )


def in_grey(picture: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return a picture (height, width, 3) in grey, (height, width, 1)."""
    grey: npt.NDArray[np.uint8] = np.rint(picture @ LUMA).astype(np.uint8)[:, :, None]
    return grey


def _add_shades(shades: list[npt.NDArray[np.float64]], look: Look) -> tuple[int, int]:
    """Add what a look, all strokes about one line, is at each distance; returns from which row to before which."""
    strokes = [stroke for stroke in look if isinstance(stroke, Stroke)]
    if len({(stroke.start, stroke.end) for stroke in strokes}) != 1 or len(strokes) != len(look):
        raise TypeError(f"{look!r}: must be strokes about one line")
    reach = max(stroke.radius for stroke in strokes) + 0.5
    distances = np.arange(0.0, reach + 2.0 / _FINENESS, 1.0 / _FINENESS)[:, None]
    rows = np.zeros((len(distances), 4))
    for stroke in strokes:
        # Of a line thinner than a pixel both borders are in it.
        outer, inner = stroke.radius - distances + 0.5, 0.5 - stroke.radius - distances
        covered = np.clip(outer, 0.0, 1.0) - np.clip(inner, 0.0, 1.0)
        opacity = stroke.color[3] / 255.0
        # It replaces what earlier strokes have left beneath it.
        rows += (np.array([*(opacity * part for part in stroke.color[:3]), opacity]) - rows) * covered
    first = sum(map(len, shades))
    shades.append(rows)
    return first, first + len(rows)


@kernel
def draw(scenery: Scenery, seen: Seen, worlds: Array, frames: Array) -> None:
    """Draw frames of some worlds.

    worlds: (n,) which rows of `frames`, (m, height, width, c) uint8, are drawn. seen: a row for each of them.
    """
    for i in range(worlds.shape[0]):
        frame = frames[worlds[i]]
        frame[:] = scenery.background
        for j in range(scenery.targets.shape[0]):
            x, y = _pixel(scenery, seen.targets[i, j, 0], seen.targets[i, j, 1])
            _draw_line(frame, scenery.shades, scenery.targets[j, 0], scenery.targets[j, 1], x, y, x, y)
        for element in range(scenery.flashes.shape[0]):
            if seen.hits[i, element] and scenery.flashes[element, 4] >= 0:
                _draw_flash(frame, scenery, element)
        for m in range(scenery.parts.shape[0]):
            lit = 2 if seen.hits[i, scenery.parts[m, 0]] else 0
            x0, y0 = _pixel(scenery, seen.cores[i, m, 0], seen.cores[i, m, 1])
            x1, y1 = _pixel(scenery, seen.cores[i, m, 2], seen.cores[i, m, 3])
            first, last = scenery.parts[m, 1 + lit], scenery.parts[m, 2 + lit]
            _draw_line(frame, scenery.shades, first, last, x0, y0, x1, y1)
        for k in range(seen.balls.shape[1]):
            if seen.alive[i, k]:
                x, y = _pixel(scenery, seen.balls[i, k, 0], seen.balls[i, k, 1])
                _draw_line(frame, scenery.shades, scenery.ball[0], scenery.ball[1], x, y, x, y)


@function
def _pixel(scenery: Scenery, x: float, y: float) -> tuple[float, float]:
    scale, left, bottom = scenery.projection[0], scenery.projection[1], scenery.projection[2]
    return left + scale * x, bottom - scale * y


@function
def _pixels_between(low: float, high: float, count: int) -> tuple[int, int]:
    """Return the first pixel that has its centre in a range, and the one after the last; of what may be far outside."""
    first, last = min(max(low - 0.5, 0.0), float(count)), min(max(high + 0.5, 0.0), float(count))
    return int(np.ceil(first)), int(last)


@function
def _draw_line(
    frame: Array, shades: Array, first: int, last: int, x0: float, y0: float, x1: float, y1: float
) -> None:  # fmt: skip
    """Draw a line in some shades, or a disc where both its ends are one; pixel coordinates."""
    reach = (last - first - 1) / _FINENESS
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    inverse = 1.0 / square if square > 0.0 else 0.0
    top, bottom = _pixels_between(min(y0, y1) - reach, max(y0, y1) + reach, frame.shape[0])
    for row in range(top, bottom):
        y = row + 0.5 - y0
        start, end = _share_near_row(y, dy, reach)
        low, high = min(start * dx, end * dx), max(start * dx, end * dx)
        left, right = _pixels_between(x0 + low - reach, x0 + high + reach, frame.shape[1])
        for column in range(left, right):
            x = column + 0.5 - x0
            along = min(max((x * dx + y * dy) * inverse, 0.0), 1.0)
            ex, ey = x - along * dx, y - along * dy
            apart = ex * ex + ey * ey
            if apart < reach * reach:
                _blend(frame, row, column, shades, first, np.sqrt(apart) * _FINENESS)


@function
def _share_near_row(y: float, dy: float, reach: float) -> tuple[float, float]:
    """Return which part of a line, from 0 to 1, is no further than `reach` from a row at height y."""
    if abs(dy) < 1e-9:
        return 0.0, 1.0
    one, other = (y - reach) / dy, (y + reach) / dy
    return min(max(min(one, other), 0.0), 1.0), min(max(one, other, 0.0), 1.0)


@function
def _blend(frame: Array, row: int, column: int, shades: Array, first: int, distance: float) -> None:
    """Put a shade over a pixel, by its distance from a line."""
    near = int(distance)
    share, channels = distance - near, frame.shape[2]
    one, other = first + near, first + near + 1
    left = 1.0 - shades[one, channels] - share * (shades[other, channels] - shades[one, channels])
    for c in range(channels):
        colour = shades[one, c] + share * (shades[other, c] - shades[one, c])
        frame[row, column, c] = np.uint8(colour + frame[row, column, c] * left + 0.5)


@function
def _draw_flash(frame: Array, scenery: Scenery, element: int) -> None:
    """Put the picture of an element that lights up on a frame, as far as it lies on it."""
    flash = scenery.flashes[element]
    channels = frame.shape[2]
    for j in range(max(-flash[1], 0), min(flash[3], frame.shape[0] - flash[1])):
        for i in range(max(-flash[0], 0), min(flash[2], frame.shape[1] - flash[0])):
            pixel = scenery.flash_pixels[flash[4] + j * flash[2] + i]
            left = 1.0 - pixel[channels] * (1.0 / 255.0)
            if left < 1.0:
                for c in range(channels):
                    below = frame[flash[1] + j, flash[0] + i, c]
                    frame[flash[1] + j, flash[0] + i, c] = np.uint8(pixel[c] + below * left + 0.5)
