"""What a person sees: the game's frame, below it what the keys do, and above it what they have to know."""

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.window.session import Session

if TYPE_CHECKING:
    import pygame

Frame = npt.NDArray[np.uint8]
Color = tuple[int, int, int]

HELP = ("P: pause", "R: new game", "V: film", "Esc: quit")

BACKGROUND, FAINT, BRIGHT, ALARM = (12, 14, 28), (150, 160, 196), (240, 243, 255), (255, 92, 92)
DIMMED = 4  # parts in 10 of the game's brightness that are left behind a text

SMALLEST = 9  # pixels: of letters that can still be read
CUT = "..."
GAP = "    "  # between two words of the help


class Screen:
    """Draws the window's picture for a session. size: (width, height) of the picture, pixels."""

    def __init__(self, session: Session) -> None:
        height, width, _ = session.frame.shape
        self._pygame = load_pygame()
        self._pygame.font.init()
        self._text = max(18, height // 36)
        words = (session.controls, *HELP) if session.controls else HELP
        self._lines = self._wrapped(words, width)
        self._row = round(1.25 * self._text)
        self._frame_height = height
        self.size = (width, height + (len(self._lines) + 2) * self._row + self._row // 2)
        self._line = lru_cache(64)(self._rendered)

    def draw(self, session: Session) -> Frame:
        """Return the picture, (height, width, 3)."""
        width, height = self.size
        pixels = np.empty((height, width, 3), np.uint8)
        pixels[:] = BACKGROUND
        pixels[: self._frame_height] = session.frame
        headlines = _headlines(session)
        if headlines:
            pixels[: self._frame_height] = pixels[: self._frame_height].astype(np.uint16) * DIMMED // 10
        target = self._pygame.image.frombuffer(pixels.data, self.size, "RGB")
        self._draw_headlines(target, headlines)
        self._draw_strip(target, session)
        return pixels

    def _draw_headlines(self, target: "pygame.Surface", headlines: tuple[tuple[str, int], ...]) -> None:
        images = [self._line(text, BRIGHT, size * self._text) for text, size in headlines]
        y = (self._frame_height - sum(image.get_height() for image in images)) // 2
        for image in images:
            target.blit(image, ((self.size[0] - image.get_width()) // 2, y))
            y += image.get_height()

    def _draw_strip(self, target: "pygame.Surface", session: Session) -> None:
        """How the game stands, below it what the keys do, and at the bottom the film."""
        y = self._frame_height + self._row // 4
        target.blit(self._line(GAP.join(session.status), BRIGHT, self._text), (self._row // 2, y))
        y += self._row
        for text in self._lines:
            target.blit(self._line(text, FAINT, self._text), (self._row // 2, y))
            y += self._row
        if session.filming:
            words = self._line("filming, V: stop", ALARM, self._text)
            dot = self._row // 4
            self._pygame.draw.circle(target, ALARM, (self._row // 2 + dot, y + words.get_height() // 2), dot)
            target.blit(words, (self._row // 2 + 4 * dot, y))
        elif session.message:
            target.blit(self._line(session.message, FAINT, self._text), (self._row // 2, y))

    def _rendered(self, text: str, color: Color, size: int) -> "pygame.Surface":
        """A line of text, in smaller letters where it is too wide for the window; where even these are, its end."""
        room = self.size[0] - self._row
        while size > SMALLEST and self._font(size).size(text)[0] > room:
            size -= 1
        while len(text) > len(CUT) and self._font(size).size(text)[0] > room:
            text = CUT + text[len(CUT) + 1 :]
        return self._font(size).render(text, True, color)

    def _font(self, size: int) -> "pygame.font.Font":
        font: pygame.font.Font = self._pygame.font.Font(None, size)
        return font

    def _wrapped(self, words: tuple[str, ...], width: int) -> list[str]:
        lines = [words[0]]
        for word in words[1:]:
            longer = f"{lines[-1]}{GAP}{word}"
            if self._font(self._text).size(longer)[0] <= width - round(1.25 * self._text):
                lines[-1] = longer
            else:
                lines.append(word)
        return lines


def _headlines(session: Session) -> tuple[tuple[str, int], ...]:
    """Return what stands across the game, each line with its size in lines of text."""
    if session.end_reason is not None:
        reason = session.end_reason.replace("_", " ")
        return ("Game over", 3), (reason, 2), (f"Score {session.score:g}", 2), ("R: play again", 1)
    if session.waits:
        return (("Press a key", 3), ("to start", 2))
    return (("Paused", 3), ("P: go on", 1)) if session.paused else ()
