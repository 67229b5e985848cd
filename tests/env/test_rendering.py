"""What render() gives: frames, the same picture in a window, one frame for each world of a batch."""

import gymnasium as gym
import numpy as np
import pytest

from bounce_env.render import Window
from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import PADDLE, assert_same, make_vec

BALL = (0.3, 0.5)  # [m] clear of everything


@pytest.fixture
def dummy_display(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


def test_a_frame_is_rgb_of_even_size_and_the_callers_own():
    env = gym.make(PADDLE, render_mode="rgb_array")
    env.reset(seed=0)
    frame = env.render()
    assert frame.dtype == np.uint8
    assert frame.ndim == 3
    assert frame.shape[2] == 3
    assert frame.shape[0] % 2 == frame.shape[1] % 2 == 0  # video codecs refuse odd sizes
    again = env.render()
    assert_same(again, frame)
    assert not np.shares_memory(again, frame)


@pytest.mark.parametrize(
    ("size", "shape"),
    [({"width": 80, "height": 60}, (60, 80, 3)), ({"width": 200}, (None, 200, 3)), ({"height": 84}, (84, None, 3))],
)
def test_width_and_height_are_honoured(size, shape):
    env = gym.make(PADDLE, render_mode="rgb_array", **size)
    env.reset(seed=0)
    frame = env.render()
    for got, asked in zip(frame.shape, shape, strict=True):
        assert got == asked or (asked is None and got % 2 == 0)
    envs = make_vec(1, render_mode="rgb_array", **size)
    envs.reset(seed=0)
    assert_same(envs.render(), (frame,))


def where_pictures_differ(one, other):
    rows, columns = np.nonzero((one != other).any(axis=2))
    return rows, columns


def test_the_ball_is_drawn_where_it_is():
    """Two launches differ in two discs: each frame shows its own ball at the place that the card's units say."""
    env = gym.make(PADDLE, render_mode="rgb_array", height=700)
    env.reset(seed=0, options={"position": BALL})
    left = env.render()
    env.reset(seed=0, options={"position": (1.0 - BALL[0], BALL[1])})
    right = env.render()
    rows, columns = where_pictures_differ(left, right)
    height, width = left.shape[:2]
    metre = height / 1.56  # the scene measures 1.5 m from the walls' feet up, and has a margin of 0.03 m
    assert rows.mean() + 0.5 == pytest.approx((1.43 - BALL[1]) * metre, abs=1.0)
    assert columns[columns < width / 2].mean() + 0.5 == pytest.approx(width / 2 - (0.5 - BALL[0]) * metre, abs=1.0)
    assert columns[columns > width / 2].mean() + 0.5 == pytest.approx(width / 2 + (0.5 - BALL[0]) * metre, abs=1.0)


def test_drawing_changes_no_bit_of_the_play():
    drawn, plain = gym.make(PADDLE, render_mode="rgb_array", height=100), gym.make(PADDLE)
    assert_same(drawn.reset(seed=1), plain.reset(seed=1))
    for _ in range(30):
        drawn.render()
        assert_same(drawn.step([0.3]), plain.step([0.3]))


def test_human_mode_shows_the_same_picture(dummy_display):
    import pygame

    human, frames = gym.make(PADDLE, render_mode="human"), gym.make(PADDLE, render_mode="rgb_array")
    human.reset(seed=2), frames.reset(seed=2)
    for action in ([1.0], [1.0], [-1.0]):
        shown = pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)
        np.testing.assert_array_equal(shown, frames.render())
        human.step(action), frames.step(action)
    assert human.render() is None
    human.close()
    assert Window._open is None
    human.close()


def test_a_batch_renders_one_frame_per_world():
    envs = make_vec(3, render_mode="rgb_array", height=140)
    envs.reset(seed=2)
    envs.step([1.0, 0.0, -1.0])
    frames = envs.render()
    assert isinstance(frames, tuple)
    for world, frame in enumerate(frames):
        env = gym.make(PADDLE, render_mode="rgb_array", height=140)
        env.reset(seed=2 + world)
        env.step([1.0 - world])
        assert_same(frame, env.render())
    assert not np.array_equal(frames[0], frames[1])


def test_sb3_gets_images_and_tiles_them():
    envs = BounceVecEnv(PADDLE, 4, seed=2, render_mode="rgb_array", height=140)
    envs.reset()
    images = envs.get_images()
    batch = make_vec(4, render_mode="rgb_array", height=140)
    batch.reset(seed=2)
    assert_same(list(images), list(batch.render()))
    height, width, _ = images[0].shape
    tiled = envs.render()
    assert tiled.shape == (2 * height, 2 * width, 3)
    np.testing.assert_array_equal(tiled[:height, width:], images[1])


def test_render_collection_is_gymnasiums_own():
    env = gym.make(PADDLE, render_mode="rgb_array_list", height=100)
    env.reset(seed=0)
    for _ in range(3):
        env.step([0.0])
    assert len(env.render()) == 4
