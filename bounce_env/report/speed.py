"""Part 4: steps and bounces a second, beside CartPole, pymunk and Box2D, in one run on one core."""

import time
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import gymnasium as gym
import numpy as np

from bounce_env.engine import World, WorldBatch
from bounce_env.report.measure import spread
from bounce_env.report.model import SpeedRow
from bounce_env.scene import Ball, Scene, Wall

GAMES = ("Bounce/Paddle-v0", "Bounce/Pinball-v0", "Bounce/Walls-v0")
BATCHES = (1, 64, 1024, 16_384, 65_536)
WALLS = (10, 100, 1000, 10_000)

Measured = Callable[[], float]
"""Does some work and returns how much of it was done a second of CPU."""


def speed_jobs(*, quick: bool) -> list[tuple[str, Callable[[], SpeedRow]]]:
    """Return what is to be measured, by name."""
    rounds, seconds = (3, 0.05) if quick else (7, 0.3)
    batches = (1, 1024) if quick else BATCHES
    found: list[tuple[str, Callable[[], SpeedRow]]] = []

    def add(what: str, peer: bool, worlds: int, unit: str, make: Callable[[], Measured]) -> None:
        def measure() -> SpeedRow:
            measured = make()
            measured()
            return SpeedRow(what, peer, worlds, unit, spread(measured() for _ in range(rounds)))

        found.append((f"speed {what} {worlds}", measure))

    for game in (*GAMES, "CartPole-v1"):
        peer = game.startswith("CartPole")
        add(f"{game}, gym.make", peer, 1, "steps", lambda game=game: _single(game, seconds))  # type: ignore[misc]
        for worlds in batches:
            label = f"{game}, vector env"
            add(label, peer, worlds, "steps", lambda g=game, n=worlds: _vector(g, n, seconds))  # type: ignore[misc]
    for game in GAMES:
        if not quick:
            label = f"{game}, vector env, 2 threads, by the clock"
            add(label, False, 8192, "steps", lambda g=game: _vector(g, 8192, seconds, num_threads=2))  # type: ignore[misc]
        for shades in ({"grayscale": True},) if quick else ({"grayscale": True}, {}):
            label = f"{game}, 84 x 84 pixels in {'grey' if shades else 'colour'}"
            add(label, False, 256, "frames", lambda g=game, s=shades: _pixels(g, seconds, **s))  # type: ignore[misc]
        label = f"{game}, clone_state and restore_state"
        add(label, False, 1, "calls", lambda g=game: _copies(g, seconds))  # type: ignore[misc]
    add("World.advance, nothing happens", False, 1, "calls", lambda: _calls(seconds))
    for name, space in (("pymunk", _pymunk), ("Box2D", _box2d)):
        if find_spec(name) is None:  # an extra: the table of methods says that it is not there
            continue
        add(f"{name}, the box scene, 1/60 s", True, 1, "steps", lambda s=space: s(seconds))  # type: ignore[misc]
    for walls in (10, 100) if quick else WALLS:
        label = f"bounces among {walls} walls"
        add(label, False, 16, "bounces", lambda n=walls: _among(n, seconds))  # type: ignore[misc]
    return found


def _timed(act: Callable[[], float], seconds: float, clock: Callable[[], float] = time.process_time) -> Measured:
    """Return a function that repeats `act`, which returns how much it has done, for some seconds by a clock."""

    def measured() -> float:
        done, begin = 0.0, clock()
        while clock() - begin < seconds:
            done += act()
        return done / (clock() - begin)

    return measured


def _single(game: str, seconds: float) -> Measured:
    env = gym.make(game)
    env.reset(seed=0)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(64)]

    def act() -> float:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(actions)

    return _timed(act, seconds)


def _vector(game: str, worlds: int, seconds: float, **more: Any) -> Measured:
    keywords: dict[str, Any] = {} if game.startswith("CartPole") else {"copy": False, **more}
    envs = gym.make_vec(game, num_envs=worlds, vectorization_mode="vector_entry_point", **keywords)
    envs.reset(seed=0)
    envs.action_space.seed(0)
    actions = [envs.action_space.sample() for _ in range(8)]

    def act() -> float:
        for action in actions:
            envs.step(action)
        return len(actions) * worlds

    return _timed(act, seconds, time.perf_counter if more.get("num_threads", 1) > 1 else time.process_time)


def _pixels(game: str, seconds: float, **more: Any) -> Measured:
    return _vector(game, 256, seconds, obs="pixels", obs_width=84, obs_height=84, **more)


def _copies(game: str, seconds: float) -> Measured:
    env: Any = gym.make(game).unwrapped
    env.reset(seed=0)

    def act() -> float:
        for _ in range(64):
            env.restore_state(env.clone_state())
        return 64

    return _timed(act, seconds)


def _calls(seconds: float) -> Measured:
    world = World(Scene(gravity=(0, 0)))
    world.reset(position=(0, 0), velocity=(1, 0))

    def act() -> float:
        for _ in range(256):
            world.advance(1e-9)
        return 256

    return _timed(act, seconds)


def _pymunk(seconds: float) -> Measured:
    from bounce_env.report.methods.pymunk_space import PymunkPlayer  # noqa: PLC0415 (an extra)

    return _stepper(PymunkPlayer, (60,), seconds)


def _box2d(seconds: float) -> Measured:
    from bounce_env.report.methods.box2d_world import Box2DPlayer  # noqa: PLC0415 (an extra)

    return _stepper(Box2DPlayer, (60, 10.0), seconds)


def _stepper(kind: Callable[..., Any], arguments: tuple[Any, ...], seconds: float) -> Measured:
    from bounce_env.report.problems import problem  # noqa: PLC0415 (imports mpmath, an extra)

    which = problem("box")
    player = kind(which, *arguments)
    player.begin(which.starts(1, 0)[0])

    def act() -> float:
        player.go(60)
        return 60

    return _timed(act, seconds)


def _among(walls: int, seconds: float) -> Measured:
    batch = _cloud(walls)

    def act() -> float:
        before = batch.counts.bounces.sum()
        batch.advance(0.5)
        return float(batch.counts.bounces.sum() - before)

    return _timed(act, seconds)


def _cloud(walls: int) -> WorldBatch:
    """Return points among short walls spread evenly in a box, so that a flight is as long however many there are."""
    rng = np.random.default_rng(walls)
    side, corners = walls**0.5, []
    for x, y in ((0, 0), (side, 0), (side, side), (0, side)):
        corners.append((float(x), float(y)))
    elements = [Wall(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]
    for _ in range(walls - 4):
        (x, y), angle = rng.uniform(0.3, side - 0.3, 2), rng.uniform(0, np.pi)
        dx, dy = 0.25 * np.cos(angle), 0.25 * np.sin(angle)
        elements.append(Wall((x - dx, y - dy), (x + dx, y + dy)))
    batch = WorldBatch(Scene(gravity=(0, 0), ball=Ball(0.0), elements=tuple(elements)), 16)
    batch.reset(position=rng.uniform(0.2, side - 0.2, (16, 2)), velocity=rng.normal(size=(16, 2)) * 3.0)
    return batch
