"""What a picture shows of a scene, and what in it is solid."""

import numpy as np
import pytest

from bounce_env import Bumper, Scene, Sensor, Wall, load_scene
from bounce_env.games.pinball.setup import hidden_of
from bounce_env.render import Picture, Renderer
from bounce_env.render.outline import clipped, islands, view_box

pytestmark = pytest.mark.fast

BOX = (Wall((0, 0), (10, 0)), Wall((10, 0), (10, 10)), Wall((10, 10), (0, 10)), Wall((0, 10), (0, 0)))
TRIANGLE = (Wall((1, 1), (2, 1)), Wall((2, 1), (1, 2)), Wall((1, 2), (1, 1)))


@pytest.mark.parametrize(
    ("sensor", "box"),
    [
        (Sensor((-5, 1), (15, 1)), (0, 0, 10, 10)),  # a drain that is wider than the field
        (Sensor((-5, -2), (15, -2)), (-5, -2, 15, 10)),  # one below it would not be seen
        (Sensor((-5, 5), (5, 16)), (-5, 0, 10, 16)),  # nor would one past a corner
        (Sensor(center=(5, 5), radius=1), (0, 0, 10, 10)),
    ],
)
def test_a_picture_shows_what_bounces_and_something_of_all_the_rest(sensor, box):
    assert view_box(Scene(elements=(*BOX, sensor))) == box


def test_clipping_against_sampling():
    generator = np.random.default_rng(0)
    for _ in range(500):
        (x0, y0), (x1, y1) = generator.uniform(-2.0, 2.0, (2, 2)).tolist()
        share = np.linspace(0.0, 1.0, 2001)
        points = np.stack([x0 + share * (x1 - x0), y0 + share * (y1 - y0)], axis=1)
        inside = points[(np.abs(points) <= 1.0).all(axis=1)]
        part = clipped(((x0, y0), (x1, y1)), (-1.0, -1.0, 1.0, 1.0))
        if len(inside) > 1:
            np.testing.assert_allclose(part, inside[[0, -1]], atol=5e-3)
        elif part is not None:
            assert np.hypot(*np.subtract(*part)) < 5e-3


def test_small_closed_chains_are_solid_and_fields_are_not():
    assert [set(chain) for chain in islands(Scene(elements=(*BOX, *TRIANGLE)))] == [{(1, 1), (2, 1), (1, 2)}]
    far = Sensor((-50, -5), (50, -5), drain=True)
    assert islands(Scene(elements=(*BOX, far))) == []
    gates = [Wall(wall.start, wall.end, one_way=True) for wall in TRIANGLE]
    assert islands(Scene(elements=(*BOX, *gates))) == []
    assert islands(Scene(elements=(*BOX, *TRIANGLE[:2]))) == []
    assert islands(Scene(elements=(*BOX, *TRIANGLE, Wall((1, 1), (1.2, 1.2))))) == []  # it branches


def test_the_slingshots_of_the_table_are_solid():
    scene = load_scene("pinball")
    assert len(islands(scene, hidden_of(scene))) == 2


def test_only_the_tables_own_words_hide_anything():
    walls = (*BOX, Wall((1, 1), (2, 2), name="bracelet"), Wall((3, 3), (4, 4), name="brace_1"), Bumper((6, 6), 1))
    assert hidden_of(Scene(elements=walls)) == (5,)


def test_a_side_that_would_be_too_long_names_the_one_that_was_asked_for():
    with pytest.raises(ValueError, match="width = 8192: must be at most") as error:
        Renderer(Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 2), (1, 2)))), width=8192)
    most = int(str(error.value).split("at most ")[1].split(",")[0])
    scene = Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 2), (1, 2))))
    from bounce_env.render.projection import LARGEST_SIDE, Projection

    assert Projection.fit(view_box(scene), width=most).height <= LARGEST_SIDE


def test_what_is_hidden_is_not_drawn():
    scene = Scene(elements=(*BOX, Bumper((5, 5), 1.0)))
    plain = Renderer(Scene(elements=BOX), 100, 100).frame(Picture(balls=()))
    assert (Renderer(scene, 100, 100, hidden=(4,)).frame(Picture(balls=())) == plain).all()
    assert (Renderer(scene, 100, 100).frame(Picture(balls=())) != plain).any()
