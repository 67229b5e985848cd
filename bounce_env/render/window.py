"""A window that shows finished frames: human and rgb_array rendering give the same picture."""

import os
import sys
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import numpy.typing as npt

from bounce_env.render.lazy_pygame import load_pygame

if TYPE_CHECKING:
    import pygame


def display_problem() -> str | None:
    """Return why no window can be seen; None where nothing is known against it.

    A driver that was chosen by SDL_VIDEODRIVER is not questioned, be it one that shows nothing.
    """
    if os.environ.get("SDL_VIDEODRIVER"):
        return None
    if sys.platform.startswith(("linux", "freebsd")):
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            return "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set"
    return None


class Window:
    """A window on the desktop that shows frames at a steady pace.

    size: (width, height) of the frames, pixels. title: in the window's bar. fps: frames a second at most.
    Raises `gymnasium.error.DependencyNotInstalled` without pygame, `pygame.error` if SDL finds no way to show
    anything; on a machine without a display it usually keeps the window in memory.

    pygame has one display: a new window takes the place of the one before, which then counts as closed.

    events: pygame's events that the last `show` found, for keys and mouse.
    """

    _open: ClassVar["Window | None"] = None

    def __init__(self, size: tuple[int, int], title: str, fps: float) -> None:
        if not fps > 0:
            raise ValueError(f"fps = {fps!r}: must be a number > 0 (frames a second)")
        self._pygame = load_pygame()
        self._size = size
        self._fps = fps
        self._clock: pygame.time.Clock = self._pygame.time.Clock()
        self.events: list[pygame.event.Event] = []
        self._pygame.display.init()
        self._surface: pygame.Surface = self._pygame.display.set_mode(size)
        self._pygame.display.set_caption(title)
        Window._open = self

    @property
    def closed(self) -> bool:
        """Whether the program or the user closed it; it does not open again."""
        return Window._open is not self or not self._pygame.display.get_init()

    def show(self, frame: npt.NDArray[np.uint8]) -> None:
        """Show a frame, (height, width, 3), handle what the user did, and wait until the next one is due.

        Does nothing in a closed window. Raises ValueError if the frame is not of the window's size.
        """
        width, height = self._size
        if frame.shape != (height, width, 3) or frame.dtype != np.uint8:
            raise ValueError(f"frame has shape {frame.shape}, {frame.dtype}: must be ({height}, {width}, 3), uint8")
        self.events = []
        if self.closed:
            return
        image = self._pygame.image.frombuffer(np.ascontiguousarray(frame), self._size, "RGB")
        self._surface.blit(image, (0, 0))
        self._pygame.display.flip()
        self.events = self._pygame.event.get()
        if any(event.type == self._pygame.QUIT for event in self.events):
            self.close()
        else:
            self._clock.tick(self._fps)

    def close(self) -> None:
        """Close the window; once more does nothing."""
        if not self.closed:
            Window._open = None
            self._pygame.display.quit()
