"""Arcs, one-way walls, circular sensors and fields, pixel by pixel."""

import math

import numpy as np
import numpy.typing as npt
import pytest

from bounce_env.render import Picture, Renderer
from bounce_env.render.shapes import still_look
from bounce_env.scene import Arc, Ball, Bumper, Element, Field, Scene, Sensor, Wall
from tests.conftest import soak_count
from tests.render.pixel_scenes import centroid, changed, distances

pytestmark = pytest.mark.fast

Pixels = npt.NDArray[np.uint8]
SIZES = [(84, 84), (256, 384), (500, 500), (None, None)]
FRAME = (Wall((0, 0), (0, 1)), Wall((1, 0), (1, 1)))
"""Two walls at the sides, so that all scenes here have the same scale."""


def drawn(*elements: Element, size: tuple[int | None, int | None] = (500, 500), hit: bool = False) -> Pixels:
    """A frame of the elements between the walls of `FRAME`, all lit or none."""
    scene = Scene(ball=Ball(0.02), max_speed=5, elements=(*FRAME, *elements))
    return Renderer(scene, *size).frame(Picture(balls=(), hits=[0, 0] + [int(hit)] * len(elements)))


def added(*elements: Element, size: tuple[int | None, int | None] = (500, 500), hit: bool = False) -> npt.NDArray:
    """How much each pixel differs from a frame without the elements."""
    return changed(drawn(*elements, size=size, hit=hit), drawn(size=size))


def places(size: tuple[int | None, int | None] = (500, 500)) -> tuple[npt.NDArray, float]:
    """The scene's coordinates of each pixel's centre, (height, width, 2), and pixels a metre."""
    projection = Renderer(Scene(elements=FRAME), *size).projection
    columns, rows = np.meshgrid(np.arange(projection.width) + 0.5, np.arange(projection.height) + 0.5)
    return projection.to_world(np.stack([columns, rows], axis=2)), projection.scale


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(("start", "end"), [(0.0, math.pi), (0.5, 6.0), (-2.0, -1.0), (0.0, 2 * math.pi)])
def test_an_arc_is_where_the_scene_says(start: float, end: float, size: tuple[int | None, int | None]) -> None:
    difference = added(Arc((0.5, 0.4), 0.3, start, end), size=size)
    at, scale = places(size)
    x, y = at[..., 0] - 0.5, at[..., 1] - 0.4
    off = np.abs(np.hypot(x, y) - 0.3) * scale  # pixels
    turned = (np.arctan2(y, x) - start) % (2 * math.pi)
    thick = max(0.75, 0.004 * min(difference.shape))
    gap = 2 / (0.3 * scale)  # its ends are round, and not looked at
    inside = (turned > gap) & (turned < end - start - gap)
    beside = (turned > end - start + 2 * gap) & (turned < 2 * math.pi - 2 * gap)
    assert (difference[inside & (off < 0.2)] > 100).all()
    assert (difference[(off > thick + 1.5)] == 0).all()
    assert (difference[beside] == 0).all()


@pytest.mark.parametrize("radius", [0.05, 0.12, 0.3, 0.45])
def test_an_arc_is_as_thick_as_a_wall(radius: float) -> None:
    """Ink a pixel's length of line: straight, round and shaken by a share of a pixel."""
    wall = added(Wall((0.2, 0.5), (0.8, 0.5))).sum() / 0.6
    ratios = []
    for i in range(soak_count(8, 60)):
        shift = 0.0003 * i
        ink = added(Arc((0.5 + shift, 0.5 - shift), radius, 0, 2 * math.pi)).sum()
        ratios.append(ink / (2 * math.pi * radius * wall))
    # the wall has two round ends: pi pen^2 more than 2 pen times its length
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.04)


def test_an_arc_is_smooth_and_round() -> None:
    difference = added(Arc((0.5, 0.5), 0.4, 0, 2 * math.pi))
    at, scale = places()
    off = (np.hypot(at[..., 0] - 0.5, at[..., 1] - 0.5) - 0.4) * scale
    turned = np.arctan2(at[..., 1] - 0.5, at[..., 0] - 0.5)
    for sector in np.linspace(-np.pi, np.pi, 49)[:-1]:
        near = (np.abs(off) < 5) & (np.abs(turned - sector - np.pi / 48) < np.pi / 48)
        assert np.average(off[near], weights=difference[near]) == pytest.approx(0, abs=0.12)
    edge = (np.abs(off) < 4) & (difference > 0)
    assert len(np.unique(difference[edge])) > 30  # shades
    assert (difference[(np.abs(off) < 1)] > 200).all()  # no gap between chords


def test_a_struck_arc_lights_up_all_along_and_nothing_else() -> None:
    arc = Arc((0.5, 0.3), 0.3, 0.5, 3.0)
    glow = changed(drawn(arc, hit=True), drawn(arc))
    at, scale = places()
    x, y = at[..., 0] - 0.5, at[..., 1] - 0.3
    off = np.abs(np.hypot(x, y) - 0.3) * scale
    turned = np.arctan2(y, x)
    along = (turned > 0.5) & (turned < 3.0)
    on = along & (off < 1)
    assert (glow[on] > 150).all()
    assert (glow[along & (off > 3) & (off < 4)] > 10).all()  # a halo beside the line
    assert drawn(arc, hit=True)[on].sum() > drawn(arc)[on].sum()
    assert (glow[(off > 8)] == 0).all()
    assert (glow[(turned < 0.5 - 8 / (0.3 * scale)) & (turned > -3)] == 0).all()


def test_an_arc_that_adds_energy_looks_different() -> None:
    at, scale = places()
    on = np.abs(np.hypot(at[..., 0] - 0.5, at[..., 1] - 0.5) - 0.3) * scale < 1
    calm, kicking, bouncy = (drawn(Arc((0.5, 0.5), 0.3, 0, 6, **more))[on] for more in ({}, {"kick": 1}, {"b": 1.5}))
    for lively in (kicking, bouncy):
        assert lively[:, 0].mean() > 1.5 * lively[:, 2].mean()
    assert calm[:, 2].mean() > 1.2 * calm[:, 0].mean()


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("way", np.linspace(0, 2 * np.pi, 7)[:-1].tolist())
def test_a_one_way_wall_shows_from_which_side_one_may_pass(way: float, size: tuple[int | None, int | None]) -> None:
    along = 0.2 * np.array([math.cos(way), math.sin(way)])
    start, end = np.array([0.5, 0.5]) - along, np.array([0.5, 0.5]) + along
    one_way, both = Wall(start, end, one_way=True), Wall(start, end)
    at, scale = places(size)
    left = (at - 0.5) @ np.array([-math.sin(way), math.cos(way)]) * scale
    ink = added(one_way, size=size)
    pen = max(0.75, 0.004 * min(ink.shape))
    assert (ink[np.abs(left) < 0.5][ink[np.abs(left) < 0.5].argsort()[-10:]] > 100).all()  # a line, too
    assert ink[left > pen + 1.5].sum() == 0  # nothing on the side that bounces
    assert ink[left < -pen - 1.5].max() > 60
    assert added(both, size=size)[left < -pen - 1.5].sum() == 0
    lit = drawn(one_way, size=size, hit=True).astype(int)
    assert lit.sum() > drawn(one_way, size=size).astype(int).sum()


def test_arrow_heads_of_a_one_way_wall_point_the_way_that_is_free() -> None:
    """Wall to the right: left of it, above, it bounces; what comes from below passes, and heads narrow upwards."""
    ink = added(Wall((0.2, 0.5), (0.8, 0.5), one_way=True))
    at, scale = places()
    below = (0.5 - at[..., 1]) * scale
    widths = [np.count_nonzero((ink > 60) & (np.abs(below - depth) < 0.5)) for depth in (4.5, 7.5)]
    heads = round(0.6 * scale / (14 * 0.004 * 500))
    assert heads > 5
    # at the tip one stroke a head, further down two
    assert 0 < widths[0] < widths[1]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("drain", [False, True])
def test_a_circular_sensor_is_a_broken_circle(drain: bool, size: tuple[int | None, int | None]) -> None:
    sensor = Sensor(center=(0.5, 0.6), radius=0.15, drain=drain)
    frame, ink = drawn(sensor, size=size), added(sensor, size=size)
    at, scale = places(size)
    away = np.hypot(at[..., 0] - 0.5, at[..., 1] - 0.6)
    pen = max(0.75, 0.004 * min(ink.shape))
    assert ink[np.abs(away - 0.15) * scale > pen + 1.5].sum() == 0
    on = np.abs(away - 0.15) * scale < 0.5
    for right in (at[..., 0] > 0.5, at[..., 0] < 0.5):
        for up in (at[..., 1] > 0.6, at[..., 1] < 0.6):
            assert 0.25 < (ink[on & right & up] > 60).mean() < 0.8  # half of it is gaps, the dashes' ends are round
    inked = frame[on & (ink > 60)].astype(int)
    strongest = 0 if drain else 1  # red or green
    assert inked[:, strongest].mean() > 1.1 * max(np.delete(inked.mean(axis=0), strongest))
    lit = drawn(sensor, size=size, hit=True)
    assert lit.astype(int).sum() > frame.astype(int).sum()
    assert changed(lit, frame)[np.abs(away - 0.15) * scale > pen + 1.5].sum() == 0


HEXAGON = [(0.5 + 0.3 * math.cos(a), 0.5 + 0.2 * math.sin(a)) for a in np.linspace(0, 2 * np.pi, 7)[:-1]]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("way", [1, -1], ids=["counter-clockwise", "clockwise"])
def test_a_field_is_a_faint_patch_of_its_shape(way: int, size: tuple[int | None, int | None]) -> None:
    ink = added(Field(HEXAGON[::way], (0, 0)), size=size)
    at, scale = places(size)
    sides = [
        ((x1 - x0) * (at[..., 1] - y0) - (y1 - y0) * (at[..., 0] - x0)) / math.hypot(x1 - x0, y1 - y0) * scale
        for (x0, y0), (x1, y1) in zip(HEXAGON, [*HEXAGON[1:], HEXAGON[0]], strict=True)
    ]
    depth = np.min(sides, axis=0)  # pixels inside
    assert (ink[depth > 1] > 8).all()
    assert (ink[depth > 1] < 60).all()  # faint: a ball is 500
    assert (ink[depth < -1] == 0).all()


def test_a_field_points_where_it_drives_the_ball() -> None:
    plain = drawn(Field(HEXAGON, (0, 0)))
    at, _ = places()
    for way in np.linspace(0, 2 * np.pi, 9)[:-1]:
        direction = np.array([math.cos(way), math.sin(way)])
        for size in (0.1, 1.0, 100.0):
            arrow = changed(drawn(Field(HEXAGON, size * direction)), plain)
            along = (at - 0.5) @ direction
            assert (arrow * along).sum() > 0.005 * arrow.sum()  # its head is heavier than its tail
            across = (at - 0.5) @ np.array([-direction[1], direction[0]])
            assert abs((arrow * across).sum()) < 0.002 * arrow.sum()


def test_a_field_lies_beneath_all_else_wherever_it_is_listed() -> None:
    field, post = Field(HEXAGON, (1, 0)), Bumper((0.5, 0.5), 0.1)
    assert (drawn(field, post) == drawn(post, field)).all()
    middle = distances(Renderer(Scene(elements=FRAME), 500, 500), (0.5, 0.5)) < 0.09 * places()[1]
    assert (drawn(field, post)[middle] == drawn(post)[middle]).all()


def test_a_struck_field_lights_up() -> None:
    field = Field(HEXAGON, (1, 0))
    assert drawn(field, hit=True).astype(int).sum() > 1.1 * drawn(field).astype(int).sum()


def test_the_score_does_not_mind_a_field_beyond_the_walls() -> None:
    def corner(*more: Element) -> npt.NDArray[np.float64]:
        scene = Scene(elements=(*FRAME, Wall((0, 1), (1, 1)), Sensor((-2, -2), (3, 3)), *more))
        renderer = Renderer(scene, 500, 500)
        return centroid(changed(*(renderer.frame(Picture((), score=score)) for score in (8, None))))

    assert corner() == pytest.approx(corner(Field(((-2, -2), (3, -2), (3, 3)), (1, 0))), abs=0.5)


@pytest.mark.parametrize("size", [(1, 1), (2, 300), (84, 84), (1120, 1120)])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e5])
def test_shapes_of_any_size_can_be_drawn_at_any_size(scale: float, size: tuple[int, int]) -> None:
    small = 2e-6 * scale
    elements = (
        *(Wall((scale * x, 0), (scale * x, scale)) for x in (0, 1)),
        Arc((scale, scale), small, 0, 2 * math.pi),
        Arc((0, 900 * scale), 900 * scale, -math.pi / 2, -math.pi / 2 + 1e-3),  # nearly straight
        Sensor(center=(0, 0), radius=small),
        Wall((0, 0), (small, 0), one_way=True),
        Field(((0, 0), (small, 0), (0, small)), (1e-9, 0)),
    )
    scene = Scene(elements=elements)
    renderer = Renderer(scene, *size)
    assert renderer.frame(Picture((), hits=np.ones(len(elements)))).shape == (size[1], size[0], 3)


@pytest.mark.parametrize("radius", [0.01, 0.1, 1.0, 4.0])
def test_a_curve_has_as_many_chords_as_one_can_see(radius: float) -> None:
    arc = Arc((0, 0), radius, 0.3, 3.3)
    scene = Scene(elements=(arc, Wall((-5, 0), (5, 0))))
    projection = Renderer(scene, 500, 500).projection
    strokes = still_look(arc, scene, projection, lit=False)
    center = projection.to_pixels((0, 0))
    for stroke in strokes:
        middle = (np.array(stroke.start) + stroke.end) / 2
        assert radius * projection.scale - math.dist(middle, center) < 0.05
    assert len(strokes) < 4 + 10 * math.sqrt(radius * projection.scale)
