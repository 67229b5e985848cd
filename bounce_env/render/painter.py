"""Strokes to pixels, with pygame's software surfaces. Import it after `load_pygame` only."""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt
import pygame

from bounce_env.render.shapes import FIELD_BOTTOM, FIELD_TOP, TEXT, TEXT_SHADOW, Look, Patch, Point, Stroke

Pixels = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float64]

FINENESS = 8
"""Strokes are drawn this many times larger and scaled down, and a moving thing is placed to 1/FINENESS pixel."""

_MOST_TURNED = 256
"""Vectors for which a look is kept; a wall that is dragged never shows the same one for long."""

_SHADES = 32
"""How many degrees of freshness of a trail are told apart."""

_SCALLOP = 0.08
"""The spots of a trail lie so close that its border is wavy by no more pixels than this."""

_BAND = 64
"""Rows of a look that are drawn at a time, so that a large one needs little memory for its FINENESS."""


def surface_of(pixels: Pixels) -> pygame.Surface:
    """Return a surface that draws into `pixels`, (height, width, 3), without a copy."""
    height, width, _ = pixels.shape
    return pygame.image.frombuffer(pixels.data, (width, height), "RGB")


def still_picture(width: int, height: int, looks: Sequence[Look]) -> Pixels:
    """Return the field with `looks` on it, later ones above earlier ones, (height, width, 3)."""
    rows = np.linspace(FIELD_TOP, FIELD_BOTTOM, height).round().astype(np.uint8)
    pixels = np.repeat(rows[:, None, :], width, axis=1)
    target = surface_of(pixels)
    for look in looks:
        Overlay(look).draw(target)
    return pixels


class Overlay:
    """A look that lies on the picture at one place; drawn when it is first needed."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._area = _area_of(look)
        self._image: pygame.Surface | None = None

    def draw(self, target: pygame.Surface) -> None:
        _stamp(target, self._drawn(), self._area.topleft)

    def picture(self) -> tuple[int, int, Pixels]:
        """Left, top, and pixels (height, width, 4): red, green, blue, multiplied by the opacity, and that."""
        image = self._drawn()
        pixels = np.frombuffer(pygame.image.tobytes(image, "RGBA"), np.uint8)
        return self._area.left, self._area.top, pixels.reshape(image.get_height(), image.get_width(), 4)

    def _drawn(self) -> pygame.Surface:
        if self._image is None:
            self._image = _rasterised(self._look, self._area)
        return self._image


class Sprite:
    """A look that moves without turning; drawn once for each fraction of a pixel at which it is seen."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._area = _area_of(look).inflate(2, 2)
        self._images: dict[tuple[int, int], pygame.Surface] = {}

    def draw(self, target: pygame.Surface, x: float, y: float) -> None:
        """Draw it with its (0, 0) at the pixel coordinates (x, y)."""
        column, right = divmod(round(x * FINENESS), FINENESS)
        row, down = divmod(round(y * FINENESS), FINENESS)
        left, top = self._area.left + column, self._area.top + row
        width, height = target.get_size()
        if not (-self._area.width < left < width and -self._area.height < top < height):
            return  # pygame takes places modulo 2^32, and would draw what lies very far outside
        image = self._images.get((right, down))
        if image is None:
            moved = [_moved(shape, right / FINENESS, down / FINENESS) for shape in self._look]
            image = self._images[right, down] = _rasterised(moved, self._area)
        _stamp(target, image, (left, top))


class Turned:
    """A look that depends on a vector, and moves; drawn once for each vector that is told apart.

    look_of: from the vector, in pixels, to a look about (0, 0).
    """

    def __init__(self, look_of: Callable[[Point], Look]) -> None:
        self._sprite_of = lru_cache(_MOST_TURNED)(lambda x, y: Sprite(look_of((x / FINENESS, y / FINENESS))))

    def draw(self, target: pygame.Surface, start: Point, end: Point) -> None:
        """Draw it with its (0, 0) at `start`, for the vector from there to `end`, pixel coordinates."""
        way = (round((end[0] - start[0]) * FINENESS), round((end[1] - start[1]) * FINENESS))
        self._sprite_of(*way).draw(target, *start)


class Trail:
    """A line that fades along its way: spots so near to each other that they cannot be told apart.

    spot_of: from a freshness, 0 to 1, to what a spot looks like about (0, 0); the freshest one is the largest.
    """

    def __init__(self, spot_of: Callable[[float], Look]) -> None:
        self._spot_of = spot_of
        self._area = _area_of(spot_of(1.0)).inflate(2, 2)
        self._spacing = max(1.0, math.sqrt(4 * self._area.width * _SCALLOP))
        self._image = lru_cache(None)(self._drawn)

    def draw(self, target: pygame.Surface, path: Floats, freshness: Floats) -> None:
        """Draw it along `path` (n, 2), pixel coordinates, n >= 1, each point as fresh as `freshness` (n,) says.

        Spots do not add up: where they overlap the brighter one is seen.
        """
        spots, fresh = _spots(path, freshness, self._spacing)
        shades = np.rint(fresh * _SHADES)
        seen = (shades > 0) & (spots > -self._area.width).all(axis=1)
        seen &= (spots < np.add(target.get_size(), self._area.width)).all(axis=1)
        places, fractions = np.divmod(np.rint(spots[seen] * FINENESS).astype(int), FINENESS)
        images = map(self._image, shades[seen].tolist(), *fractions.T.tolist())
        target.fblits(zip(images, (places + self._area.topleft).tolist(), strict=True), pygame.BLEND_RGB_MAX)

    def _drawn(self, shade: float, right: int, down: int) -> pygame.Surface:
        look = self._spot_of(shade / _SHADES)
        # On black, without opacity, which pygame would take six times longer to draw.
        spot = pygame.Surface(self._area.size, 0, 24)
        moved = [_moved(shape, right / FINENESS, down / FINENESS) for shape in look]
        _stamp(spot, _rasterised(moved, self._area), (0, 0))
        return spot


def _spots(path: Floats, freshness: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Points every `spacing` pixels along a path, back from its end, and how fresh each is."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    places = np.arange(along[-1], -1e-9, -spacing)
    x, y, fresh = (np.interp(places, along, values) for values in (*path.T, freshness))
    return np.stack([x, y], axis=1), fresh


class Label:
    """A line of text about a middle, made smaller where it is wider than the room that it has."""

    def __init__(self, middle: int, top: int, room: int, size: int) -> None:
        pygame.font.init()
        self._font = pygame.font.Font(None, size)
        self._middle = middle
        self._top = top
        self._room = room
        self._text = ""
        self._image = pygame.Surface((0, 0))

    def draw(self, target: pygame.Surface, text: str) -> None:
        if text != self._text:
            self._text, self._image = text, self._printed(text)
        _stamp(target, self._image, (self._middle - self._image.get_width() // 2, self._top))

    def _printed(self, text: str) -> pygame.Surface:
        width, height = self._font.size(text)
        shadow = height // 20  # small letters would drown in it
        image = pygame.Surface((width + shadow, height + shadow), pygame.SRCALPHA)
        for color, place in ((TEXT_SHADOW, (shadow, shadow)), (TEXT, (0, 0))):
            image.blit(self._font.render(text, True, color), place)
        image = image.premul_alpha()
        if image.get_width() <= self._room:
            return image
        height = max(1, round(image.get_height() * self._room / image.get_width()))
        return pygame.transform.smoothscale(image, (self._room, height))


def _stamp(target: pygame.Surface, image: pygame.Surface, place: tuple[int, int]) -> None:
    target.blit(image, place, special_flags=pygame.BLEND_PREMULTIPLIED)


def _area_of(look: Look) -> pygame.Rect:
    """Return the whole pixels that a look touches."""
    reaches = [reach for shape in look for reach in _reaches(shape)]
    left, right = (math.floor(min(x - r for x, _, r in reaches)), math.ceil(max(x + r for x, _, r in reaches)))
    top, bottom = (math.floor(min(y - r for _, y, r in reaches)), math.ceil(max(y + r for _, y, r in reaches)))
    return pygame.Rect(left, top, right - left, bottom - top)


def _reaches(shape: Stroke | Patch) -> list[tuple[float, float, float]]:
    """Points x, y of a shape, and how far around each it reaches."""
    if isinstance(shape, Patch):
        return [(x, y, 0.0) for x, y in shape.corners]
    return [(x, y, shape.radius) for x, y in (shape.start, shape.end)]


def _moved(shape: Stroke | Patch, right: float, down: float) -> Stroke | Patch:
    if isinstance(shape, Patch):
        return Patch(tuple((x + right, y + down) for x, y in shape.corners), shape.color)
    (x0, y0), (x1, y1) = shape.start, shape.end
    return Stroke((x0 + right, y0 + down), (x1 + right, y1 + down), shape.radius, shape.color)


def _rasterised(look: Sequence[Stroke | Patch], area: pygame.Rect) -> pygame.Surface:
    """Return what a look leaves on an area of the picture, with colours multiplied by their opacity.

    Only so is the mean of an opaque and a clear pixel right: a clear one has no colour to give.
    """
    image = pygame.Surface(area.size, pygame.SRCALPHA)
    for top in range(area.top, area.bottom, _BAND):
        rows = min(_BAND, area.bottom - top)
        fine = pygame.Surface((area.width * FINENESS, rows * FINENESS), pygame.SRCALPHA)
        for shape in look:
            _draw_fine(fine, _moved(shape, -area.left, -top))
        _stamp(image, pygame.transform.smoothscale(fine.premul_alpha(), (area.width, rows)), (0, top - area.top))
    return image


def _draw_fine(fine: pygame.Surface, shape: Stroke | Patch) -> None:
    if isinstance(shape, Patch):
        corners = [(math.floor(FINENESS * x), math.floor(FINENESS * y)) for x, y in shape.corners]
        pygame.draw.polygon(fine, shape.color, corners)
        return
    (x0, y0), (x1, y1) = [(FINENESS * x, FINENESS * y) for x, y in (shape.start, shape.end)]
    radius = FINENESS * shape.radius
    for x, y in {(x0, y0), (x1, y1)}:
        pygame.draw.circle(fine, shape.color, (round(x), round(y)), round(radius))
    length = math.hypot(x1 - x0, y1 - y0)
    if length > 0:
        nx, ny = (y0 - y1) / length, (x1 - x0) / length
        # A polygon covers the pixels of its outline, too: half a pixel less on each side keeps it as wide as the discs.
        reach = radius - 0.5
        sides = ((x0, y0, reach), (x1, y1, reach), (x1, y1, -reach), (x0, y0, -reach))
        outline = [(math.floor(x + side * nx), math.floor(y + side * ny)) for x, y, side in sides]
        pygame.draw.polygon(fine, shape.color, outline)
