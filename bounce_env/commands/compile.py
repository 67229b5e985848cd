"""`compile`."""

import time
from collections.abc import Callable
from functools import partial

from tqdm import tqdm

from bounce_env.commands.cli import FINE, Refused, say
from bounce_env.engine import World, WorldBatch
from bounce_env.engine.compile.cache import cache_folder
from bounce_env.engine.world_kernels import world_advance
from bounce_env.lab.kernels import compile_game, compile_world
from bounce_env.lab.table import free_place
from bounce_env.registration import ENTRIES, games
from bounce_env.scene import Scene, SceneError, load_scene

QUICK = 3.0
"""Seconds of CPU in which nothing is compiled: kernels that are on disk are loaded."""


def compile_kernels(names: tuple[str, ...]) -> int:
    """Compile what is named, and say what took how long."""
    jobs = [job for name in names or ("all",) for job in _jobs(name)]
    with tqdm(total=len(jobs), unit=" kernels", disable=None, leave=False) as bar:
        for name, act in jobs:
            bar.set_postfix_str(name)
            began = time.process_time()
            act()
            seconds = time.process_time() - began
            bar.update()
            bar.clear()
            say(f"{name}: {'was there' if seconds < QUICK else 'compiled'} ({seconds:.1f} s)")
    folder = cache_folder(world_advance)
    say(f"kept in {folder}" if folder else "kept nowhere: no folder can be written (bounce-env doctor says more)")
    return FINE


def _jobs(name: str) -> list[tuple[str, Callable[[], None]]]:
    """Return what a name stands for: all, a game or a scene, each with what compiles it."""
    if name == "all":
        played = [(entry.id, partial(compile_game, entry.id, "")) for entry in ENTRIES]
        worlds = [
            ("worlds with a disc", partial(compile_world, 0.05)),
            ("worlds with a point", partial(compile_world, 0.0)),
        ]
        return [*played, *worlds]
    env_id = games().get(name, name)
    if env_id in games().values():
        return [(env_id, partial(compile_game, env_id, ""))]
    try:
        return [(name, partial(_compile_scene, load_scene(name)))]
    except SceneError as error:
        raise Refused(f"{error}; or a game, or all") from error


def _compile_scene(scene: Scene) -> None:
    """Compile the kernels that a scene needs in a `World` and in a `WorldBatch`."""
    world = World(scene)
    place = free_place(world, scene)
    world.reset(position=place, velocity=(0.0, 0.0))
    world.advance(0.01, ledger=True)
    batch = WorldBatch(scene, 1)
    batch.reset(position=[place], velocity=[(0.0, 0.0)])
    batch.advance(0.01)
