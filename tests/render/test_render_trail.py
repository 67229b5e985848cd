"""The trail behind a ball, pixel by pixel."""

import numpy as np
import pytest

from bounce_env.render import Picture, Renderer
from bounce_env.scene import Ball, Scene, Wall

pytestmark = pytest.mark.fast

WALLS = (Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)))


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return Renderer(Scene(ball=Ball(radius=0.02), elements=WALLS), 300, 300)


def light(renderer: Renderer, trail: list[tuple[float, float, float]]) -> np.ndarray:
    """How much brighter a trail makes each pixel, (height, width)."""
    blank = renderer.frame(Picture(balls=())).astype(int)
    more = renderer.frame(Picture(balls=(), trail=trail)) - blank
    assert more.min() >= 0
    return more.sum(axis=2)


@pytest.mark.parametrize("end", [(0.8, 0.2), (0.8, 0.47), (0.51, 0.8)])
def test_the_edges_of_a_trail_are_smooth_and_straight(renderer: Renderer, end: tuple[float, float]) -> None:
    """It looks like a band: as bright along its middle, and its border nowhere wavy."""
    start = (0.2, 0.2)
    more = light(renderer, [(*start, 1.0), (*end, 1.0)])
    (x0, y0), (x1, y1) = renderer.projection.to_pixels([start, end])
    rows, columns = np.mgrid[:300, :300] + 0.5
    length = np.hypot(x1 - x0, y1 - y0)
    along = ((columns - x0) * (x1 - x0) + (rows - y0) * (y1 - y0)) / length
    across = np.abs((columns - x0) * (y1 - y0) - (rows - y0) * (x1 - x0)) / length
    inside = (along > 5) & (along < length - 5)
    radius = 0.6 * 0.02 * renderer.projection.scale
    full = more[inside & (across < radius - 1)]
    assert np.ptp(full) < 0.15 * full.max()  # of the field beneath, which gets darker downwards
    edge = inside & (np.abs(across - radius) < 2)
    covered = np.clip(0.5 + radius - across[edge], 0.0, 1.0)
    assert edge.sum() > 500
    assert np.abs(more[edge] / full.mean() - covered).max() < 0.3
    assert (more[inside & (across > radius + 1)] == 0).all()


def test_it_gets_fainter_and_thinner_with_age_and_ends_in_nothing(renderer: Renderer) -> None:
    more = light(renderer, [(0.1, 0.5, 0.0), (0.9, 0.5, 1.0)])
    left, right = np.round(renderer.projection.to_pixels([(0.1, 0.5), (0.9, 0.5)])[:, 0]).astype(int)
    peaks, widths = more.max(axis=0)[left:right], (more > 0).sum(axis=0)[left:right]
    assert peaks[0] == 0
    assert np.diff(peaks).max() < 0.1 * peaks.max()
    assert (np.diff(peaks) >= -2).all()
    assert widths[-10] > widths[len(widths) // 3] > 0


def test_where_a_trail_crosses_itself_it_is_no_brighter(renderer: Renderer) -> None:
    line = [(0.3, 0.5, 0.5), (0.7, 0.5, 0.5)]
    once, twice = (light(renderer, trail) for trail in (line, [*line, (0.5, 0.7, 0.5), (0.5, 0.3, 0.5)]))
    x, y = renderer.projection.to_pixels((0.5, 0.5)).astype(int)
    assert (twice[y - 1 : y + 1, x - 1 : x + 1] == once[y - 1 : y + 1, x - 1 : x + 1]).all()
    assert once[y, x] > 0
    assert (twice > 0).sum() > 1.5 * (once > 0).sum()


def test_a_ball_lies_on_its_trail_and_parts_outside_the_picture_are_cut(renderer: Renderer) -> None:
    trail = [(-3.0, 0.5, 1.0), (0.5, 0.5, 1.0)]
    frame = renderer.frame(Picture(balls=[(0.5, 0.5)], trail=trail))
    bare = renderer.frame(Picture(balls=[(0.5, 0.5)]))
    x, y = renderer.projection.to_pixels((0.5, 0.5)).astype(int)
    assert (frame[y - 3 : y + 4, x - 3 : x + 4] == bare[y - 3 : y + 4, x - 3 : x + 4]).all()
    changed = (frame != bare).any(axis=2)
    assert changed[:, 0].sum() == changed[:, 20].sum() > 5
    assert not changed[:, x + 10 :].any()


@pytest.mark.parametrize("trail", [None, (), np.zeros((0, 3)), [(0.5, 0.5, 0.0)], [(9.0, 9.0, 1.0)]])
def test_nothing_to_show_draws_nothing(renderer: Renderer, trail: object) -> None:
    assert (renderer.frame(Picture(balls=(), trail=trail)) == renderer.frame(Picture(balls=()))).all()


@pytest.mark.parametrize(
    ("trail", "message"),
    [
        ([(0.5, 0.5)], r"trail has shape \(1, 2\): must be \(n, 3\)"),
        ([(0.5, np.nan, 1.0)], r"trail = .*nan.*finite"),
        ([(0.5, 0.5, 1.5)], r"trail = .*1\.5.*from 0 to 1"),
        ([(0.5, 0.5, np.nan)], r"trail = .*nan.*from 0 to 1"),
    ],
)
def test_a_bad_trail_is_named(renderer: Renderer, trail: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        renderer.frame(Picture(balls=(), trail=trail))
