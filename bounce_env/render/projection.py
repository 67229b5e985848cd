"""From the scene's metres (y up) to the picture's pixels (y down) and back."""

from dataclasses import dataclass
from numbers import Integral
from typing import Self

import numpy as np
import numpy.typing as npt

DEFAULT_HEIGHT = 560
"""Height of a picture for which no size was asked, pixels."""

LONGEST_SHAPE = 4.0
"""A picture whose size follows the scene is at most this many times longer than wide: a scene of one
level wall would else be drawn on a ribbon."""

LARGEST_SIDE = 8192
"""A picture is asked for with at most this width or height, pixels."""

MARGIN = 0.02
"""Empty border around a scene, as a share of its longer side: a stroke centred on the border is drawn whole."""


@dataclass(frozen=True)
class Projection:
    """An affine map that keeps shapes. Pixel i covers [i, i + 1), so a pixel's centre is at i + 0.5.

    width, height: of the picture, pixels. scale: pixels per metre. left, bottom: the pixel coordinates
    (x, y) of the scene's origin.
    """

    width: int
    height: int
    scale: float
    left: float
    bottom: float

    @classmethod
    def fit(
        cls, bounds: tuple[float, float, float, float], width: int | None = None, height: int | None = None
    ) -> Self:
        """Return the map that shows all of `bounds` (x_min, y_min, x_max, y_max in metres), centred, with a margin.

        width, height: pixels. One left out follows the shape of `bounds` and is even, as video codecs
        demand; with both left out the height is `DEFAULT_HEIGHT`; with both given the scene is letterboxed.
        Raises ValueError unless they are integers from 1 to `LARGEST_SIDE`.
        """
        width, height = _checked("width", width), _checked("height", height)
        x_min, y_min, x_max, y_max = bounds
        longer = max(x_max - x_min, y_max - y_min) or 1.0
        across = x_max - x_min + 2 * MARGIN * longer
        up = y_max - y_min + 2 * MARGIN * longer
        aspect = min(max(across / up, 1 / LONGEST_SHAPE), LONGEST_SHAPE)
        asked = ("width", width) if height is None else ("height", height)
        if height is None:
            height = DEFAULT_HEIGHT if width is None else _even(width / aspect)
        if width is None:
            width = _even(height * aspect)
        if max(width, height) > LARGEST_SIDE:
            most = int(asked[1] * LARGEST_SIDE / max(width, height)) if asked[1] else 0
            words = (
                f"must be at most {most}, for the other side follows the scene's shape and is at most {LARGEST_SIDE}"
            )
            raise ValueError(f"{asked[0]} = {asked[1]}: {words}")
        scale = min(width / across, height / up)
        return cls(
            width,
            height,
            scale,
            left=width / 2 - scale * (x_min + x_max) / 2,
            bottom=height / 2 + scale * (y_min + y_max) / 2,
        )

    def to_pixels(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Pixel coordinates of points (..., 2) in metres; of the same shape."""
        return np.asarray(points, dtype=np.float64) * (self.scale, -self.scale) + (self.left, self.bottom)

    def to_world(self, pixels: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Metres of pixel coordinates (..., 2), as of a mouse; of the same shape."""
        return (np.asarray(pixels, dtype=np.float64) - (self.left, self.bottom)) / (self.scale, -self.scale)


def _checked(name: str, pixels: int | None) -> int | None:
    if pixels is None:
        return None
    if isinstance(pixels, bool) or not isinstance(pixels, Integral) or not 1 <= pixels <= LARGEST_SIDE:
        raise ValueError(f"{name} = {pixels!r}: must be None or an integer from 1 to {LARGEST_SIDE} (pixels)")
    return int(pixels)


def _even(pixels: float) -> int:
    return max(2, 2 * round(pixels / 2))
