"""Sizes of a picture, and the map between metres and pixels."""

import numpy as np
import pytest

from bounce_env.render import Projection
from bounce_env.render.projection import DEFAULT_HEIGHT, LARGEST_SIDE, LONGEST_SHAPE, MARGIN
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

BOUNDS = (-0.5, 0.2, 0.5, 1.6)


def corners(bounds: tuple[float, float, float, float]) -> list[tuple[float, float]]:
    x0, y0, x1, y1 = bounds
    return [(x0, y0), (x1, y1), (x0, y1), (x1, y0)]


def test_default_size_is_560_high_and_of_the_scenes_shape() -> None:
    projection = Projection.fit(BOUNDS)
    assert projection.height == DEFAULT_HEIGHT == 560
    (x0, y0), (x1, y1) = projection.to_pixels(corners(BOUNDS)[:2])
    left, right, top, bottom = x0, projection.width - x1, y1, projection.height - y0
    assert np.allclose([left, right], bottom, atol=1.0)  # as wide to the sides, but for the rounding to even
    assert top == pytest.approx(bottom)
    assert bottom > 5


@pytest.mark.parametrize("given", range(84, 700, 7))
def test_the_size_left_out_is_even_and_of_the_scenes_shape(given: int) -> None:
    x0, y0, x1, y1 = BOUNDS
    by_height, by_width = Projection.fit(BOUNDS, height=given), Projection.fit(BOUNDS, width=given)
    assert by_height.height == given
    assert by_width.width == given
    assert by_height.width % 2 == by_width.height % 2 == 0
    padded = (x1 - x0 + 0.056) / (y1 - y0 + 0.056)
    assert abs(by_height.width - given * padded) <= 1.0
    assert abs(by_width.height - given / padded) <= 1.0


def test_random_boxes_lie_inside_centred_and_undistorted() -> None:
    rng = np.random.default_rng(1)
    for _ in range(soak_count(200, 20_000)):
        low = rng.uniform(-100, 100, 2)
        bounds = (*low, *(low + rng.uniform(0.001, 100, 2)))
        width, height = (int(side) for side in rng.integers(1, 2000, 2))
        projection = Projection.fit(bounds, width, height)
        pixels = projection.to_pixels(corners(bounds))
        assert (pixels > 0).all()
        assert (pixels < (width, height)).all()
        assert np.allclose(pixels.mean(axis=0), (width / 2, height / 2))
        extent = np.ptp(pixels, axis=0)
        assert max((extent + 2 * MARGIN * extent.max()) / (width, height)) == pytest.approx(1.0)  # fills it one way
        points = rng.uniform(-1000, 1000, (5, 2))
        assert np.allclose(projection.to_world(projection.to_pixels(points)), points)
        moved = projection.to_pixels(points + np.array((1.0, 2.0))) - projection.to_pixels(points)
        assert np.allclose(moved, (projection.scale, -2.0 * projection.scale))  # y points up, and down in pixels


@pytest.mark.parametrize(
    ("bounds", "size"),
    [
        ((0.0, 0.0, 100.0, 0.0), (LONGEST_SHAPE * DEFAULT_HEIGHT, DEFAULT_HEIGHT)),
        ((0.0, 0.0, 0.0, 100.0), (DEFAULT_HEIGHT / LONGEST_SHAPE, DEFAULT_HEIGHT)),
        ((3.0, 3.0, 3.0, 3.0), (DEFAULT_HEIGHT, DEFAULT_HEIGHT)),
    ],
)
def test_flat_scenes_get_a_picture_of_a_sane_shape(
    bounds: tuple[float, float, float, float], size: tuple[float, float]
) -> None:
    projection = Projection.fit(bounds)
    assert (projection.width, projection.height) == size
    assert np.isfinite(projection.scale)


@pytest.mark.parametrize("side", ["width", "height"])
@pytest.mark.parametrize("value", [0, -3, 84.0, "84", True, LARGEST_SIDE + 1])
def test_a_bad_size_names_itself_and_what_is_allowed(side: str, value: object) -> None:
    with pytest.raises(ValueError, match=rf"{side} = .*{value!r}.*integer from 1 to 8192"):
        Projection.fit(BOUNDS, **{side: value})  # type: ignore[arg-type]


def test_numpy_integers_are_sizes() -> None:
    assert Projection.fit(BOUNDS, np.int64(84), np.uint8(84)) == Projection.fit(BOUNDS, 84, 84)
