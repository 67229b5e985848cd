"""The trail behind the ball, and frames at the instant of a bounce: `trail` and `show_bounces`."""

import math

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import Flipper
from bounce_env.envs.trail import Flight, Trail
from tests.env.rollouts import PADDLE, PINBALL, assert_same, make_vec

RADIUS = 0.02  # [m] of the paddle game's ball
G = 1.5  # m/s^2
WALL = 1.0 - RADIUS  # [m] where the ball's centre is when it touches the right wall


def made(env_id=PADDLE, **kwargs):
    env = gym.make(env_id, disable_env_checker=True, **kwargs).unwrapped
    env.reset(seed=0)
    return env


def thrown(velocity, position=(0.9, 0.5), **kwargs):
    env = made(**kwargs)
    env.reset(seed=0, options={"position": position, "velocity": velocity})
    return env


def test_no_trail_unless_asked():
    env = made()
    env.step([0.0])
    assert env.picture().trail is None


def test_the_trail_is_the_path_of_the_last_seconds_and_fades():
    env = thrown((0.3, 1.0), (0.3, 0.4), trail=0.2)
    for _ in range(9):
        env.step([0.0])
    x, y, fresh = env.picture().trail.T
    t = 0.3 - 0.2 * (1.0 - fresh)  # when, in the flight
    np.testing.assert_allclose(fresh[[0, -1]], (0.0, 1.0), atol=1e-12)
    assert (np.diff(fresh) > 0).all()
    np.testing.assert_allclose(x, 0.3 + 0.3 * t, atol=1e-12)
    # Between two points a chord replaces the curve: g dt^2 / 8, far less than a pixel.
    np.testing.assert_allclose(y, 0.4 + t - G / 2 * t * t, atol=G / 8 / 60**2 * 1.01)


@pytest.mark.parametrize("frame_skip", [1, 2, 7])
def test_the_trail_goes_through_the_very_place_of_a_bounce(frame_skip):
    env = thrown((1.0, 0.6), trail=0.5, frame_skip=frame_skip)
    for _ in range(1 + 12 // frame_skip):
        env.step([0.0])
    trail = env.picture().trail
    hit = (WALL - 0.9) / 1.0
    bounce = trail[trail[:, 0].argmax()]
    np.testing.assert_allclose(bounce[:2], (WALL, 0.5 + 0.6 * hit - G / 2 * hit**2), atol=1e-9)
    x, y, fresh = trail[: trail[:, 0].argmax() + 1].T  # and up to there it is the flight's curve
    t = env._batch.episodes[0].frames / 60 - 0.5 * (1.0 - fresh)
    np.testing.assert_allclose(x, 0.9 + t, atol=1e-9)
    np.testing.assert_allclose(y, 0.5 + 0.6 * t - G / 2 * t * t, atol=1e-9)
    assert np.diff(t).max() <= 1 / 60 + 1e-9


def test_several_bounces_in_a_step_are_cut_short_but_for_the_last():
    way = Trail(1.0)
    way.go_on(0, Flight(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0), 0.1, 0.2)
    way.go_on(0, Flight(5.0, 5.0, 0.0, 1.0, 0.0, 0.0, 0.15), 0.2, 0.2)
    np.testing.assert_allclose(way.until(0.2)[[0, 1, -1], :2], [(0.1, 0.0), (5.0, 5.0), (5.0, 5.05)])


@pytest.mark.parametrize(
    ("ball", "now", "goes_on"), [(0, 0.2, True), (1, 0.2, False), (0, 0.4, False), (0, 0.1, False)]
)
def test_another_ball_an_earlier_time_and_a_gap_begin_a_new_trail(ball, now, goes_on):
    way, flight = Trail(1.0), Flight(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    way.go_on(0, flight, 0.1, 0.051)
    way.go_on(0, flight, 0.15, 0.051)
    way.go_on(ball, flight, now, 0.051)
    assert way.until(now)[0, 0] == pytest.approx(0.1 if goes_on else now)


def test_a_new_episode_and_a_ball_that_was_served_have_no_trail_yet():
    env = thrown((0.3, 1.0), trail=5.0)
    for _ in range(5):
        env.step([0.0])
    env.reset()
    assert len(np.unique(env.picture().trail[:, :2], axis=0)) == 1
    table = made(PINBALL, trail=5.0)
    table.reset(seed=0)
    for _ in range(2000):
        before = table._batch.state.worlds[0].time_hi
        *_, terminated, _, _ = table.step(0)
        served = table._batch.state.worlds[0].time_hi - before > table._batch.game.step_seconds * 1.01
        # From where it was lost the ball does not come back through the air.
        assert not served or len(np.unique(table.picture().trail[:, :2], axis=0)) == 1
        if terminated:
            break
    assert terminated


def test_a_trail_is_drawn_where_the_ball_has_been_and_fades():
    env = thrown((0.0, 1.2), (0.1, 0.3), trail=0.4, render_mode="rgb_array", height=600)
    plain = thrown((0.0, 1.2), (0.1, 0.3), render_mode="rgb_array", height=600)
    for _ in range(12):
        env.step([0.0]), plain.step([0.0])
    more = env.render().astype(int) - plain.render()
    assert more.min() >= 0  # it lights up what it covers
    rows, columns = np.nonzero(more.any(axis=2))
    metre = 600 / 1.56
    x = 0.1 * metre + (env.render().shape[1] - metre) / 2
    assert np.abs(columns + 0.5 - x).max() < RADIUS * metre
    assert (rows.max() - rows.min()) / metre == pytest.approx(1.2 * 0.4 - G * 0.4**2 / 2, abs=0.06)
    light = more.sum(axis=(1, 2))[rows.min() + 16 : rows.max() + 1]  # below the ball
    smooth = np.convolve(light, np.ones(9) / 9, "valid")
    assert (np.diff(smooth) <= 3).all()  # older is fainter, without steps
    assert light[-1] < 0.1 * light[0]


def test_single_and_vector_draw_the_same_trails():
    kwargs = {"trail": 0.3, "show_bounces": True, "render_mode": "rgb_array", "height": 120}
    envs, single = make_vec(2, "SAME_STEP", **kwargs), made(**kwargs)
    envs.reset(seed=4), single.reset(seed=5)
    for _ in range(60):
        envs.step(np.zeros((2, 1)))
        _, _, terminated, _, _ = single.step([0.0])
        if terminated:
            single.reset()
        assert_same(envs.render()[1], single.render())
        assert_same(envs.picture(1).trail, single.picture().trail)


def test_a_frame_of_a_bounce_shows_the_ball_on_the_wall_that_is_lit():
    env, plain = thrown((1.0, 0.6), show_bounces=True), thrown((1.0, 0.6))
    right = [e.name for e in env._batch.game.scenes[0].elements].index("right")
    seen = []
    for _ in range(5):
        env.step([0.0]), plain.step([0.0])
        picture, end = env.picture(), plain.picture()
        seen.append(bool(picture.hits[right]))
        if picture.hits[right]:
            hit = WALL - 0.9
            np.testing.assert_allclose(picture.balls[0], (WALL, 0.5 + 0.6 * hit - G / 2 * hit**2), atol=1e-12)
            assert end.balls[0, 0] < WALL - 0.01
        else:
            assert_same(picture.balls, end.balls)
    assert seen == [False, False, True, False, False]


def test_the_paddle_is_shown_where_it_was_hit():
    env = thrown((0.0, -1.0), (0.6, 0.2), show_bounces=True)
    rows = []
    for _ in range(4):
        env.step([1.0])
        rows.append((env.picture().balls[0, 1], env.picture().cores[0], env._batch.view(0)[1][0]))
    shown = [t for t, (y, _, _) in enumerate(rows) if not np.array_equal(rows[t][1], rows[t][2])]
    assert len(shown) == 1
    y, core, later = rows[shown[0]]
    assert y - core[1] == pytest.approx(0.015 + RADIUS, abs=0.011)
    assert 0.0 < later[0] - core[0] < 1.5 / 30


def test_a_flipper_that_has_stopped_since_is_shown_on_its_way_where_it_struck():
    """A stroke takes 25 ms, a step 33: at its end the flipper is up, and the ball gone."""
    env = made(PINBALL, show_bounces=True)
    env.action_space.seed(1)
    scene = env._batch.game.scenes[0]
    parts = [i for i, _ in scene.parts]
    flippers = {i: part for i, part in scene.parts if isinstance(part, Flipper)}
    struck = moved = 0
    for _ in range(3000):
        _, _, terminated, truncated, _ = env.step(env.action_space.sample())
        state, picture = env._batch.state, env.picture()
        for i in state.touches["element"][0, : state.balls[0, 0].touched].tolist():
            if i in flippers and state.hits[0, i]:
                x0, y0, x1, y1 = picture.cores[parts.index(i)]
                gap = distance(picture.balls[0], (x0, y0), (x1, y1)) - scene.ball.radius - flippers[i].radius
                assert abs(gap) < 1e-6
                struck += 1
                moved += not np.allclose(picture.cores, env._batch.view(0)[1])
        if terminated or truncated:
            env.reset()
    assert struck > 20
    assert moved > 5


def distance(point, start, end):
    along = np.subtract(end, start)
    share = np.clip(np.dot(np.subtract(point, start), along) / np.dot(along, along), 0.0, 1.0)
    return math.dist(point, np.add(start, share * along))


def test_looking_at_bounces_changes_no_bit_of_the_play():
    env, plain = (thrown((1.0, 0.6), **kwargs) for kwargs in ({"show_bounces": True, "trail": 1.0}, {}))
    for _ in range(40):
        env.picture()
        one, other = env.step([0.3]), plain.step([0.3])
        assert_same(one, other)
        if one[2]:
            break
    assert_same(env.clone_state().data, plain.clone_state().data)


def test_a_picture_needs_a_reset():
    with pytest.raises(gym.error.ResetNeeded, match="picture"):
        gym.make(PADDLE, disable_env_checker=True).unwrapped.picture()
    with pytest.raises(gym.error.ResetNeeded, match="picture"):
        make_vec(2).picture(1)
