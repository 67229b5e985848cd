"""Strokes to pixels, with pygame's software surfaces. Import it after `load_pygame` only."""

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt
import pygame

from bounce_env.render.looks import FIELD_BOTTOM, FIELD_TOP, TEXT, TEXT_SHADOW, Look, Stroke

Pixels = npt.NDArray[np.uint8]

FINENESS = 4
"""Strokes are drawn this many times larger and scaled down, and a moving thing is placed to 1/FINENESS pixel."""

_BAND = 64
"""Rows of a picture that are drawn at a time, so that a large picture needs little memory for its FINENESS."""


def surface_of(pixels: Pixels) -> pygame.Surface:
    """A surface that draws into `pixels`, (height, width, 3), without a copy."""
    height, width, _ = pixels.shape
    return pygame.image.frombuffer(pixels, (width, height), "RGB")


def still_picture(width: int, height: int, strokes: Look) -> Pixels:
    """The field with `strokes` on it, (height, width, 3)."""
    rows = np.linspace(FIELD_TOP, FIELD_BOTTOM, height).round().astype(np.uint8)
    pixels = np.repeat(rows[:, None, :], width, axis=1)
    target = surface_of(pixels)
    for top in range(0, height, _BAND):
        band = pygame.Rect(0, top, width, min(_BAND, height - top))
        _stamp(target, _rasterised(strokes, band), band.topleft)
    return pixels


class Overlay:
    """A look that lies on the picture at one place; drawn when it is first needed."""

    def __init__(self, look: Look, width: int, height: int) -> None:
        self._look = look
        self._area = _area_of(look).clip(pygame.Rect(0, 0, width, height))
        self._image: pygame.Surface | None = None

    def draw(self, target: pygame.Surface) -> None:
        if self._image is None:
            self._image = _rasterised(self._look, self._area)
        _stamp(target, self._image, self._area.topleft)


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
        place = self._area.move(column, row)
        if not place.colliderect(target.get_rect()):
            return
        image = self._images.get((right, down))
        if image is None:
            moved = [_moved(stroke, right / FINENESS, down / FINENESS) for stroke in self._look]
            image = self._images[right, down] = _rasterised(moved, self._area)
        _stamp(target, image, place.topleft)


class Label:
    """A line of text in the top left corner, as large as the picture's height suggests and its width allows."""

    def __init__(self, width: int, height: int) -> None:
        pygame.font.init()
        self._inset = round(0.045 * min(width, height))
        self._room = width - 2 * self._inset
        self._size = max(11, round(0.065 * height))
        self._text = ""
        self._image = pygame.Surface((0, 0))

    def draw(self, target: pygame.Surface, text: str) -> None:
        if text != self._text:
            self._text, self._image = text, self._printed(text)
        target.blit(self._image, (self._inset, self._inset))

    def _printed(self, text: str) -> pygame.Surface:
        font = self._font(text)
        shift = max(1, font.get_height() // 16)
        width, height = font.size(text)
        image = pygame.Surface((width + shift, height + shift), pygame.SRCALPHA)
        for color, place in ((TEXT_SHADOW, (shift, shift)), (TEXT, (0, 0))):
            image.blit(font.render(text, True, color), place)
        return image

    def _font(self, text: str) -> pygame.font.Font:
        for size in range(self._size, 1, -1):
            font = pygame.font.Font(None, size)
            if font.size(text)[0] <= self._room:
                return font
        return pygame.font.Font(None, 1)


def _stamp(target: pygame.Surface, image: pygame.Surface, place: tuple[int, int]) -> None:
    target.blit(image, place, special_flags=pygame.BLEND_PREMULTIPLIED)


def _area_of(look: Iterable[Stroke]) -> pygame.Rect:
    """The whole pixels that a look touches."""
    xs = [(point[0], stroke.radius) for stroke in look for point in (stroke.start, stroke.end)]
    ys = [(point[1], stroke.radius) for stroke in look for point in (stroke.start, stroke.end)]
    left, right = (math.floor(min(x - r for x, r in xs)), math.ceil(max(x + r for x, r in xs)))
    top, bottom = (math.floor(min(y - r for y, r in ys)), math.ceil(max(y + r for y, r in ys)))
    return pygame.Rect(left, top, right - left, bottom - top)


def _moved(stroke: Stroke, right: float, down: float) -> Stroke:
    (x0, y0), (x1, y1) = stroke.start, stroke.end
    return Stroke((x0 + right, y0 + down), (x1 + right, y1 + down), stroke.radius, stroke.color)


def _rasterised(strokes: Iterable[Stroke], area: pygame.Rect) -> pygame.Surface:
    """What `strokes` leave on an area of the picture, with colours multiplied by their opacity.

    Only so is the mean of an opaque and a clear pixel right: a clear one has no colour to give.
    """
    fine = pygame.Surface((area.width * FINENESS, area.height * FINENESS), pygame.SRCALPHA)
    for stroke in strokes:
        _draw_fine(fine, _moved(stroke, -area.left, -area.top))
    return pygame.transform.smoothscale(fine.premul_alpha(), area.size)


def _draw_fine(fine: pygame.Surface, stroke: Stroke) -> None:
    (x0, y0), (x1, y1) = [(FINENESS * x, FINENESS * y) for x, y in (stroke.start, stroke.end)]
    radius = FINENESS * stroke.radius
    for x, y in {(x0, y0), (x1, y1)}:
        pygame.draw.circle(fine, stroke.color, (round(x), round(y)), round(radius))
    length = math.hypot(x1 - x0, y1 - y0)
    if length > 0:
        across, up = -radius * (y1 - y0) / length, radius * (x1 - x0) / length
        corners = ((x0, y0, 1), (x1, y1, 1), (x1, y1, -1), (x0, y0, -1))
        # A polygon covers the pixels of its corners, too: half a pixel less keeps it in the middle.
        outline = [(x + side * across - 0.5, y + side * up - 0.5) for x, y, side in corners]
        pygame.draw.polygon(fine, stroke.color, outline)
