"""Frames, pixel by pixel."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from bounce_env.engine.placement import part_cores_at_start
from bounce_env.render import Picture, Renderer, painter
from bounce_env.render.shapes import Stroke
from bounce_env.scene import Ball, Bumper, Flipper, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene
from tests.conftest import soak_count
from tests.render.pixel_scenes import (
    INDEX,
    PADDLE,
    TABLE,
    ball_color,
    centroid,
    changed,
    distances,
    empty_table,
    hits_on,
    paddle_at,
    table_renderer,
)

pytestmark = pytest.mark.fast

SIZES = [(84, 84), (256, 384), (400, 560), (None, None)]


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return table_renderer()


def random_points(count: int, seed: int = 0) -> list[list[float]]:
    return np.random.default_rng(seed).uniform((0.05, 0.15), (0.95, 1.35), (count, 2)).tolist()


def test_a_frame_is_a_new_contiguous_rgb_array(renderer: Renderer) -> None:
    frame = empty_table(renderer)
    assert frame.shape == (560, 400, 3)
    assert frame.dtype == np.uint8
    assert frame.flags.c_contiguous
    assert frame.flags.owndata
    assert frame.flags.writeable
    kept = frame.copy()
    frame[:] = 0
    assert (empty_table(renderer) == kept).all()


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_ball_is_where_the_projection_puts_it(width: int | None, height: int | None) -> None:
    renderer = table_renderer(width, height)
    empty = empty_table(renderer)
    radius = max(0.02 * renderer.projection.scale, 1.5)
    for point in random_points(soak_count(50, 500)):
        frame = renderer.frame(Picture(balls=[point], cores=PADDLE))
        away = distances(renderer, point)
        assert (frame[away < radius - 0.8] == ball_color(renderer)).all()
        assert (changed(frame, empty)[away > 1.8 * radius + 2] == 0).all()


def test_the_ball_is_as_large_as_the_scene_says(renderer: Renderer) -> None:
    radius = 0.02 * renderer.projection.scale
    for point in random_points(20):
        frame = renderer.frame(Picture(balls=[point], cores=PADDLE))
        pure = (frame == ball_color(renderer)).all(axis=2).sum()
        assert np.pi * (radius - 1) ** 2 < pure < np.pi * radius**2


def test_a_ball_moves_by_its_share_of_a_pixel() -> None:
    renderer = Renderer(Scene(ball=Ball(radius=0.05), elements=(Bumper((0.5, -5.0), 0.01), Wall((0, 1), (1, 1)))))
    # Two dark elements far away: only the field's slow gradient lies beneath the ball.
    empty = renderer.frame(Picture(balls=()))
    step = 0.3 / renderer.projection.scale
    for i in range(soak_count(40, 400)):
        point = (0.4 + 0.37 * i * step % 0.3, 0.1 + i * step % 0.5)
        seen = centroid(changed(renderer.frame(Picture(balls=[point])), empty))
        # Half of 1/FINENESS from rounding the place, as much from the raster that draws it.
        assert np.abs(seen - renderer.projection.to_pixels(point)).max() < 1 / painter.FINENESS


def test_y_points_up(renderer: Renderer) -> None:
    empty = empty_table(renderer)
    low, high = (centroid(changed(renderer.frame(Picture(balls=[(0.5, y)], cores=PADDLE)), empty)) for y in (0.3, 0.8))
    assert low[1] - high[1] == pytest.approx(0.5 * renderer.projection.scale, abs=0.3)
    assert low[0] == pytest.approx(high[0], abs=0.1)


def test_every_ball_in_play_is_drawn_and_no_other(renderer: Renderer) -> None:
    points = [(0.5, 0.7), (0.5, 1.2), (0.8, 0.3)]
    frame = renderer.frame(Picture(balls=points, cores=PADDLE, alive=[True, False, True]))
    assert (frame == renderer.frame(Picture(balls=points[::2], cores=PADDLE))).all()
    for point, drawn in zip(points, (True, False, True), strict=True):
        assert (frame[distances(renderer, point) < 3] == ball_color(renderer)).all() == drawn


@pytest.mark.parametrize("point", [(-1.0, 0.5), (0.5, -0.4), (1e9, 1e9), (-1e12, 3.0), (0.5, 1e15)])
def test_a_ball_outside_the_picture_is_not_seen(renderer: Renderer, point: tuple[float, float]) -> None:
    assert (renderer.frame(Picture(balls=[point], cores=PADDLE)) == empty_table(renderer)).all()


@pytest.mark.parametrize("pixel", [(2**32 + 200, 280), (200, 280 - 2**32), (200, 2**40 + 280), (1e30, 280)])
def test_pixels_do_not_wrap_around(renderer: Renderer, pixel: tuple[float, float]) -> None:
    point = renderer.projection.to_world(pixel)
    assert (renderer.frame(Picture(balls=[point], cores=PADDLE)) == empty_table(renderer)).all()


def test_a_ball_half_outside_is_cut_at_the_border() -> None:
    renderer = Renderer(Scene(ball=Ball(radius=0.1), elements=(Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)))), 200, 200)
    for pixel in ((0, 100), (200, 100), (100, 0), (100, 200), (0, 0), (200, 200)):
        point = renderer.projection.to_world(pixel)
        frame = renderer.frame(Picture(balls=[point]))
        assert (frame[distances(renderer, point) < 15] == (255, 252, 240)).all()


@pytest.mark.parametrize(("width", "height"), [*SIZES, (800, 1120)])
def test_the_point_ball_is_a_dot_one_can_see(width: int | None, height: int | None) -> None:
    scene = Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 1.4), (1, 1.4))))
    renderer = Renderer(scene, width, height)
    empty = renderer.frame(Picture(balls=()))
    for point in random_points(20):
        difference = changed(renderer.frame(Picture(balls=[point])), empty)
        assert (difference > 300).sum() >= 4
        away = distances(renderer, point)
        assert difference[away > 8].max() == 0


def test_a_paddle_is_as_long_and_thick_as_the_scene_says(renderer: Renderer) -> None:
    scale = renderer.projection.scale
    for x in np.linspace(0.1, 0.9, 17):
        frame = renderer.frame(Picture(balls=(), cores=paddle_at(x)))
        other = renderer.frame(Picture(balls=(), cores=paddle_at(0.9 if x < 0.5 else 0.1)))
        covered = changed(frame, other) > 100
        column, row = renderer.projection.to_pixels((x, 0.08))
        near = np.abs(np.arange(400) + 0.5 - column) < 0.13 * scale
        covered &= near
        rows, columns = np.nonzero(covered)
        assert np.ptp(columns) + 1 == pytest.approx(2 * 0.112 * scale, abs=2.0)
        assert np.ptp(rows) + 1 == pytest.approx(2 * 0.012 * scale, abs=2.0)
        assert columns.mean() + 0.5 == pytest.approx(column, abs=0.5)
        assert rows.mean() + 0.5 == pytest.approx(row, abs=0.5)


def test_a_paddle_lies_along_its_rail() -> None:
    paddle = Paddle((0.2, 0.2), (0.8, 0.8), half_width=0.15, radius=0.02, max_speed=1.0)
    renderer = Renderer(Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)), paddle)))
    color = renderer.frame(Picture(balls=(), cores=[_slanted(0.5)]))[_at(renderer, (0.5, 0.5))].tolist()
    frame = renderer.frame(Picture(balls=(), cores=[_slanted(0.4)]))
    for along, across, covered in ((0.14, 0, True), (-0.14, 0, True), (0.2, 0, False), (0, 0.1, False), (0, 0, True)):
        point = (0.4 + (along - across) / 2**0.5, 0.4 + (along + across) / 2**0.5)
        assert (frame[_at(renderer, point)].tolist() == color) == covered, (along, across)


def _slanted(x: float) -> tuple[float, float, float, float]:
    off = 0.15 / 2**0.5
    return x - off, x - off, x + off, x + off


def _at(renderer: Renderer, point: tuple[float, float]) -> tuple[int, int]:
    x, y = renderer.projection.to_pixels(point)
    return int(y), int(x)


def test_all_but_the_moving_parts_stays_the_same(renderer: Renderer) -> None:
    first = renderer.frame(Picture(balls=[(0.3, 0.7)], cores=paddle_at(0.3), score=1))
    second = renderer.frame(Picture(balls=[(0.8, 1.2)], cores=paddle_at(0.7), score=1))
    difference = changed(first, second)
    scale = renderer.projection.scale
    for point, reach in (((0.3, 0.7), 0.04), ((0.8, 1.2), 0.04), ((0.3, 0.08), 0.115), ((0.7, 0.08), 0.115)):
        here = distances(renderer, point) < reach * scale + 3
        assert difference[here].max() > 100
        difference[here] = 0
    assert (difference == 0).all()


@pytest.mark.parametrize("radius", [1.0, 1.6, 2.5, 4.0])
def test_walls_are_equally_thick_whichever_way_they_run(radius: float) -> None:
    ratios = []
    for angle in np.linspace(0.0, np.pi, soak_count(20, 400), endpoint=False):
        along = 40.0 * np.array([np.cos(angle), np.sin(angle)])
        center = np.array([60.3, 59.6]) + angle
        start, end = (tuple(center + side * along) for side in (-1, 1))
        pixels = painter.still_picture(130, 130, [(Stroke(start, end, radius, (255, 255, 255, 255)),)])
        field = painter.still_picture(130, 130, [])
        covered = changed(pixels, field) / changed(np.full_like(field, 255), field)
        ratios.append(covered.sum() / (2 * radius * 80 + np.pi * radius**2))
    # Each side is rounded to 1/FINENESS pixel; on the average nothing is added or lost.
    assert np.abs(np.array(ratios) - 1).max() < 1 / (painter.FINENESS * radius)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.01)


def test_edges_are_smooth() -> None:
    scene = Scene(ball=Ball(radius=0.1), elements=(Wall((0.1, 0.1), (0.9, 0.6)), Wall((0, 0), (1, 0))))
    renderer = Renderer(scene, height=300)
    frame = renderer.frame(Picture(balls=[(0.3, 0.5)]))
    for (x, y), kind in (((0.5, 0.35), "wall"), ((0.3, 0.4), "ball")):
        row, column = _at(renderer, (x, y))
        strip = frame[row - 12 : row + 12, column - 12 : column + 12, 0].astype(int)
        low, high = strip.min(), strip.max()
        between = ((strip > low + 15) & (strip < high - 15)).sum()
        shades = len(np.unique(strip))
        assert high - low > 60, kind
        assert between >= 24, kind  # at least a pixel in each column of the edge
        assert shades > 10, kind


@pytest.mark.parametrize(("width", "height"), SIZES)
@pytest.mark.parametrize("name", [name for name in INDEX if name != "paddle"])
def test_what_is_struck_lights_up_and_nothing_else(name: str, width: int | None, height: int | None) -> None:
    renderer = table_renderer(width, height)
    calm = empty_table(renderer)
    lit = renderer.frame(Picture(balls=(), cores=PADDLE, hits=hits_on(name)))
    difference = changed(lit, calm)
    x0, y0, x1, y1 = TABLE.elements[INDEX[name]].bounds
    (left, top), (right, bottom) = renderer.projection.to_pixels([(x0, y1), (x1, y0)])
    reach = 0.06 * renderer.projection.scale + 4
    columns, rows = np.arange(difference.shape[1]) + 0.5, np.arange(difference.shape[0])[:, None] + 0.5
    near = (columns > left - reach) & (columns < right + reach) & (rows > top - reach) & (rows < bottom + reach)
    assert difference[near].max() > 150
    assert difference[~near].max() == 0
    assert lit.astype(int).sum() > calm.astype(int).sum()  # brighter
    assert (empty_table(renderer) == calm).all()  # and it goes out again


def test_a_struck_paddle_lights_up(renderer: Renderer) -> None:
    calm = empty_table(renderer)
    lit = renderer.frame(Picture(balls=(), cores=PADDLE, hits=hits_on("paddle")))
    at_paddle = distances(renderer, (0.5, 0.08))
    assert lit[at_paddle < 3].sum() > calm[at_paddle < 3].sum()
    assert changed(lit, calm)[at_paddle > 0.15 * renderer.projection.scale].max() == 0


def test_what_adds_energy_looks_different(renderer: Renderer) -> None:
    frame = empty_table(renderer)
    lively, post = (frame[distances(renderer, c) < 0.06 * renderer.projection.scale] for c in ((0.25, 1), (0.75, 1)))
    assert lively[:, 0].mean() > 1.5 * lively[:, 2].mean()
    assert post[:, 2].mean() > 1.2 * post[:, 0].mean()


@pytest.mark.parametrize(("width", "height"), [*SIZES, (84, 600), (600, 84)])
@pytest.mark.parametrize("score", [0, 7, -0.5, 1234.5, 1e6, 1e20, -1e300])
def test_the_score_is_printed_whole_inside_the_field(width: int | None, height: int | None, score: float) -> None:
    renderer = table_renderer(width, height)
    inked = changed(renderer.frame(Picture(balls=(), cores=PADDLE, score=score)), empty_table(renderer)) > 0
    (left, top), (right, bottom) = renderer.projection.to_pixels([(0.0, 1.4), (1.0, 0.0)])
    rows, columns = np.nonzero(inked)
    assert left < columns.min()
    assert columns.max() + 1 < right
    assert top < rows.min()
    assert rows.max() + 1 < top + 0.2 * max(bottom - top, 84)


def test_the_score_is_inside_the_walls_though_a_sensor_reaches_beyond_them() -> None:
    walls = (Wall((0, 0), (0, 1)), Wall((1, 0), (1, 1)), Wall((0, 1), (1, 1)))
    renderer = Renderer(Scene(elements=(*walls, Sensor((-2, -1), (3, 2)))))
    blank, printed = (renderer.frame(Picture(balls=(), score=score)) for score in (None, 123456))
    rows, columns = np.nonzero(changed(printed, blank))
    (left, top), (right, bottom) = renderer.projection.to_pixels([(0, 1), (1, 0)])
    assert left < columns.min()
    assert columns.max() + 1 < right
    assert top < rows.min()
    assert rows.max() + 1 < bottom


def test_other_scores_give_other_pictures(renderer: Renderer) -> None:
    scores = [None, 0, 1, 12, 21, 0.5, -0.5, 1000, 10000]
    frames = {renderer.frame(Picture(balls=(), cores=PADDLE, score=score)).tobytes() for score in scores}
    assert len(frames) == len(scores)


def test_no_zero_has_a_sign(renderer: Renderer) -> None:
    zeros = [renderer.frame(Picture(balls=(), cores=PADDLE, score=zero)) for zero in (0, 0.0, -0.0, np.float32(0))]
    assert all((zero == zeros[0]).all() for zero in zeros)


def busy_picture(i: int) -> Picture:
    return Picture(
        balls=random_points(3, seed=i), cores=paddle_at(0.1 + 0.1 * (i % 9)), hits=np.arange(9) % 3 == i % 3, score=i
    )


def test_the_same_picture_gives_the_same_bytes_whatever_was_drawn_before() -> None:
    first, second = Renderer(TABLE, 256, 384), Renderer(TABLE, 256, 384)
    forward = [first.frame(busy_picture(i)).tobytes() for i in range(20)]
    backward = [second.frame(busy_picture(i)).tobytes() for i in reversed(range(20))]
    assert forward == backward[::-1]
    assert len(set(forward)) == 20


def test_another_process_gives_the_same_bytes() -> None:
    program = (
        "import hashlib; from tests.render.pixel_scenes import TABLE;"
        "from tests.render.test_render_frame import busy_picture;"
        "from bounce_env.render import Renderer;"
        "print(hashlib.sha256(Renderer(TABLE).frame(busy_picture(5))).hexdigest())"
    )
    paths = [path for path in sys.path if path]
    answer = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {paths!r}; {program}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert answer.stdout.strip() == hashlib.sha256(Renderer(TABLE).frame(busy_picture(5))).hexdigest()


def test_bands_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = []
    for rows in (10_000, 64, 5):
        monkeypatch.setattr(painter, "_BAND", rows)
        frames.append(Renderer(TABLE, 256, 384).frame(busy_picture(1)))
    assert (frames[0] == frames[1]).all()
    assert (frames[0] == frames[2]).all()


def test_later_elements_lie_above_earlier_ones() -> None:
    colors = []
    walls, post = (Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1))), Bumper((0.5, 0.5), 0.2)
    for elements in (
        (post, *walls),
        (post, *walls, Wall((0.1, 0.5), (0.9, 0.5))),
        (Wall((0.1, 0.5), (0.9, 0.5)), post),
    ):
        renderer = Renderer(Scene(elements=elements), 400, 400)
        colors.append(renderer.frame(Picture(balls=()))[_at(renderer, (0.6, 0.5))].tolist())
    assert colors[0] == colors[2] != colors[1]


@pytest.mark.parametrize("name", builtin_scenes())
@pytest.mark.parametrize(("width", "height"), [*SIZES, (1, 1), (2, 300), (300, 2)])
def test_built_in_scenes_can_be_drawn_at_any_size(name: str, width: int | None, height: int | None) -> None:
    scene = load_scene(name)
    renderer = Renderer(scene, width, height)
    cores = [[x0, y0, x1, y1] for (x0, y0), (x1, y1) in part_cores_at_start(scene).values()]
    x0, y0, x1, y1 = scene.bounds
    center = ((x0 + x1) / 2, (y0 + y1) / 2)
    frame = renderer.frame(Picture([center], cores, hits=np.ones(len(scene.elements)), score=123.0))
    assert frame.shape == (renderer.projection.height, renderer.projection.width, 3)
    assert frame.max() > 200


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("balls", [0.5, 0.5], r"balls has shape \(2,\): must be \(k, 2\)"),
        ("balls", [(0.5, np.nan)], r"balls = .*nan.*finite"),
        ("cores", (), r"cores has shape \(0, 4\): must be \(1, 4\)"),
        ("cores", [(0.5, np.inf, 0.5, 0.5)], r"cores = .*inf.*finite"),
        ("alive", [True], r"alive has shape \(1,\): must be \(2,\)"),
        ("hits", [0, 1], r"hits has shape \(2,\): must be \(9,\)"),
        ("score", np.nan, "score = nan: must be None or finite"),
    ],
)
def test_a_bad_picture_names_the_field(renderer: Renderer, field: str, value: object, message: str) -> None:
    good = {"balls": [(0.5, 0.5), (0.6, 0.6)], "cores": PADDLE}
    with pytest.raises(ValueError, match=message):
        renderer.frame(Picture(**{**good, field: value}))


def test_a_dragged_wall_is_drawn_between_its_ends() -> None:
    """Wherever they are, and however often they have moved."""
    wall = Wall((0.2, 0.5), (0.8, 0.5), draggable=True)
    renderer = Renderer(Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)), wall)), 400, 400)
    empty = renderer.frame(Picture(balls=(), cores=[(0.1, 0.1, 0.2, 0.1)]))
    for turn in range(600):
        frame = renderer.frame(Picture(balls=(), cores=[(0.2, 0.3 + 0.0005 * turn, 0.8, 0.9 - 0.0005 * turn)]))
    for share in (0.05, 0.5, 0.95):
        y = (1.0 - share) * 0.5995 + share * 0.6005
        place = _at(renderer, (0.2 + 0.6 * share, y))
        assert (frame[place] != empty[place]).any(), share
    place = _at(renderer, (0.5, 0.55))
    assert (frame[place] == empty[place]).all()


def test_parts_are_drawn_where_their_cores_are() -> None:
    """A flipper along its core at any angle, and a bumper on a rail away from where the scene puts it."""
    flipper = Flipper((0.5, 0.3), 0.3, radius=0.03, rest_angle=0.0, active_angle=1.0, up_speed=9.0, down_speed=9.0)
    bumper = Bumper((0.2, 0.8), 0.05, rail_end=(0.8, 0.8), speed=1.0)
    renderer = Renderer(Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)), flipper, bumper)), 400, 400)
    color, rim = None, None
    for angle in np.linspace(0.0, 1.0, 5).tolist():
        ux, uy = float(np.cos(angle)), float(np.sin(angle))
        x = 0.2 + 0.6 * angle
        frame = renderer.frame(Picture(balls=(), cores=[(0.5, 0.3, 0.5 + 0.3 * ux, 0.3 + 0.3 * uy), (x, 0.8, x, 0.8)]))
        color = frame[_at(renderer, (0.5, 0.3))].tolist() if color is None else color
        for along, across, covered in ((0.15, 0, True), (0.32, 0, True), (0.36, 0, False), (0.15, 0.05, False)):
            point = (0.5 + along * ux - across * uy, 0.3 + along * uy + across * ux)
            assert (frame[_at(renderer, point)].tolist() == color) == covered, (angle, along, across)
        rim = frame[_at(renderer, (x, 0.8))].tolist() if rim is None else rim
        assert frame[_at(renderer, (x, 0.8))].tolist() == rim
        assert (frame[_at(renderer, (0.2, 0.8))].tolist() == rim) == (angle == 0.0)
