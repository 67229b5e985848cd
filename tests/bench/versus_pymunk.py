"""How many steps a second `Bounce/Paddle-v0` makes on one thread, and pymunk stepping the same scene.

Run `python -m tests.bench.versus_pymunk` for the table; both are measured in turns, so that noise hits both alike.
pymunk does less: one step of its physics per step of the env, no observation, no reward, no reset.
"""

import statistics
import time
from collections.abc import Callable

import gymnasium as gym
import numpy as np
import pymunk

from bounce_env import Bumper, Paddle, Wall, load_scene
from bounce_env.games.batch import Batch
from bounce_env.games.episode import NEXT_STEP
from bounce_env.games.paddle.game import PaddleGame
from bounce_env.games.paddle.setup import PaddleOptions

WORLDS = 1024
STEP = 1.0 / 30.0


def pymunk_space() -> tuple[pymunk.Space, pymunk.Body]:
    """The scene of the paddle game, the drain closed so that the ball stays in play, and its paddle."""
    scene = load_scene("paddle")
    space = pymunk.Space()
    space.gravity = scene.gravity
    paddle_body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    shapes: list[pymunk.Shape] = [pymunk.Segment(space.static_body, (0.0, 0.0), (1.0, 0.0), 0.0)]
    for element in scene.elements:
        if isinstance(element, Wall):
            shapes.append(pymunk.Segment(space.static_body, element.start, element.end, 0.0))
        elif isinstance(element, Bumper):
            shapes.append(pymunk.Circle(space.static_body, element.radius, element.center))
        elif isinstance(element, Paddle):
            half = element.half_width
            paddle_body.position = (0.5, element.rail_start[1])
            shapes.append(pymunk.Segment(paddle_body, (-half, 0.0), (half, 0.0), element.radius))
    ball = pymunk.Body(1.0, float("inf"))
    ball.position, ball.velocity = (0.4, 0.55), (0.7, 1.3)
    shapes.append(pymunk.Circle(ball, scene.ball.radius))
    for shape in shapes:
        shape.elasticity = 1.0
    space.add(ball, paddle_body, *shapes)
    return space, paddle_body


def batch_steps(seconds: float) -> Callable[[], float]:
    """A function that measures the steps per second of the native batch once: physics, rules, observation, resets."""
    game = PaddleGame(PaddleOptions())
    batch = Batch(game, WORLDS, autoreset=NEXT_STEP)
    for w in range(WORLDS):
        batch.seed(w, np.uint64(w))
    batch.reset(np.ones(WORLDS, np.bool_))
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (64, WORLDS))
    return measured(batch.step, actions, seconds)


def vector_steps(seconds: float) -> Callable[[], float]:
    """A function that measures the steps per second of the Gymnasium vector env once: all that, and info."""
    envs = gym.make_vec("Bounce/Paddle-v0", num_envs=WORLDS, vectorization_mode="vector_entry_point", copy=False)
    envs.reset(seed=0)
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (64, WORLDS, 1)).astype(np.float32)
    return measured(envs.step, actions, seconds)


def measured(step: Callable[[np.ndarray], object], actions: np.ndarray, seconds: float) -> Callable[[], float]:
    """A function that measures once, with what is compiled or warmed up behind it."""
    for k in range(200):
        step(actions[k % 64])

    def measure() -> float:
        steps, begin = 0, time.perf_counter()
        while time.perf_counter() - begin < seconds:
            for k in range(64):
                step(actions[k])
            steps += 64 * WORLDS
        return steps / (time.perf_counter() - begin)

    return measure


def bare_steps(seconds: float) -> Callable[[], float]:
    """A function that measures pymunk's steps per second once, with a paddle that stands: no Python between steps."""
    space, _ = pymunk_space()

    def measure() -> float:
        steps, begin = 0, time.perf_counter()
        while time.perf_counter() - begin < seconds:
            for _ in range(256):
                space.step(STEP)
            steps += 256
        return steps / (time.perf_counter() - begin)

    return measure


def steered_steps(seconds: float) -> Callable[[], float]:
    """A function that measures pymunk's steps per second once, with the paddle steered and held at its stops."""
    space, paddle = pymunk_space()
    speeds = np.random.default_rng(0).uniform(-1.5, 1.5, 256).tolist()

    def measure() -> float:
        steps, begin = 0, time.perf_counter()
        while time.perf_counter() - begin < seconds:
            for speed in speeds:
                outward = (paddle.position.x - 0.5) * speed > 0.0 and abs(paddle.position.x - 0.5) > 0.355
                paddle.velocity = (0.0 if outward else speed, 0.0)
                space.step(STEP)
            steps += len(speeds)
        return steps / (time.perf_counter() - begin)

    return measure


def compare(seconds: float, rounds: int = 7) -> list[float]:
    """Median steps per second of batch, vector env, pymunk steered and bare, over rounds in which they take turns."""
    measures = [make(seconds) for make in (batch_steps, vector_steps, steered_steps, bare_steps)]
    table = [[measure() for measure in measures] for _ in range(rounds)]
    return [statistics.median(column) for column in zip(*table, strict=True)]


if __name__ == "__main__":
    batch, vector, steered, bare = compare(seconds=0.5)
    print(f"{WORLDS} worlds of Bounce/Paddle-v0 on one thread against pymunk {pymunk.version}, medians of one run:")  # noqa: T201
    print(f"pymunk, paddle steered  {steered / 1e6:6.3f} M steps/s")  # noqa: T201
    print(f"pymunk, bare step       {bare / 1e6:6.3f} M steps/s")  # noqa: T201
    for name, ours in (("native batch", batch), ("Gymnasium vector env", vector)):
        print(f"{name:22}  {ours / 1e6:6.3f} M steps/s, {ours / steered:.0f} and {ours / bare:.0f} times")  # noqa: T201
