"""A film of a play: an MP4 file that appears when it is complete."""

from collections.abc import Generator
from contextlib import ExitStack
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import numpy.typing as npt

from bounce_env.files import replacing

Frame = npt.NDArray[np.uint8]


class Film:
    """An MP4 file in the making.

    path: of the file; its folder must be there. size: (width, height) of the frames in pixels; odd ones are scaled to
    even ones. fps: frames a second. OSError, here and in every method, where it cannot be written: then it leaves no
    file.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: float) -> None:
        self.path = path
        self._stack = ExitStack()
        unfinished = self._stack.enter_context(replacing(path))
        encoder = imageio_ffmpeg.write_frames(unfinished, size, fps=fps, macro_block_size=2, ffmpeg_log_level="error")
        self._encoder: Generator[None, Frame | None, None] = encoder
        self._guarded(None)

    def add(self, frame: Frame) -> None:
        """Add a frame, (height, width, 3)."""
        self._guarded(np.ascontiguousarray(frame))

    def finish(self) -> None:
        """Complete the file under its name."""
        try:
            self._encoder.close()
        except OSError as error:
            self._give_up(error)
        self._stack.close()

    def _guarded(self, frame: Frame | None) -> None:
        try:
            self._encoder.send(frame)
        except OSError as error:
            self._give_up(error)
            raise

    def _give_up(self, error: OSError) -> None:
        self._stack.__exit__(type(error), error, error.__traceback__)
