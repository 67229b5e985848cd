"""A film of a play: an MP4 file that appears when it is complete."""

import subprocess
from contextlib import ExitStack
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import numpy.typing as npt

from bounce_env.files import replacing

Frame = npt.NDArray[np.uint8]

PATIENCE = 60.0
"""Seconds that the encoder is given to complete a file."""


class Film:
    """An MP4 file in the making.

    path: of the file. size: (width, height) of the frames in pixels; odd ones are scaled to even ones, as H.264 needs
    them. fps: frames a second. Where the file cannot be written, here or later, OSError says why, and nothing is left.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: float) -> None:
        self.path = path
        self._stack = ExitStack()
        unfinished = self._stack.enter_context(replacing(path))
        unfinished.touch()  # a folder that is not there, or not ours, is told now
        width, height = size
        self._encoder = subprocess.Popen(
            [
                *(imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-loglevel", "error"),
                *("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(fps), "-i", "-"),
                *("-vf", "scale=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p", str(unfinished)),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )

    def add(self, frame: Frame) -> None:
        """Add a frame, (height, width, 3)."""
        assert self._encoder.stdin is not None
        try:
            self._encoder.stdin.write(np.ascontiguousarray(frame).data)
        except OSError:
            self.finish()  # says what has ended the encoder, where a broken pipe says nothing
            raise

    def finish(self) -> None:
        """Complete the file under its name."""
        with self._stack:
            try:
                _, words = self._encoder.communicate(timeout=PATIENCE)
            except subprocess.TimeoutExpired as error:
                self._encoder.kill()
                self._encoder.communicate()
                raise OSError(f"{self.path}: the encoder did not end in {PATIENCE:g} s") from error
            if self._encoder.returncode != 0:
                lines = words.decode(errors="replace").split("\n")
                raise OSError(f"{self.path}: {lines[0] or f'the encoder ended with {self._encoder.returncode}'}")
