"""The house stays one that a stranger can walk through: few parameters, every file in its room, few calls a step."""

import ast
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
import numba
import pytest

import bounce_env
from bounce_env import Ball, Scene, Wall, World

pytestmark = pytest.mark.fast

PACKAGE = Path(bounce_env.__file__).parent
ENGINE = PACKAGE / "engine"
ROOMS = {"compile", "memory", "motion", "impact", "detect", "contact", "events"}
FACE = {
    "__init__",
    "arguments",
    "world",
    "world_batch",
    "world_kernels",
    "packing",
    "placement",
    "recorded",
    "carried_over",
    "snapshot",
    "tolerances",
    "tutorial",
}


def functions() -> list[tuple[Path, ast.FunctionDef]]:
    return [
        (path, node)
        for path in sorted(ENGINE.rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef)
    ]


def test_no_function_has_more_than_ten_parameters():
    found = functions()
    assert len(found) > 300
    many = [f"{path.name}: {f.name}" for path, f in found if len(f.args.args) + len(f.args.kwonlyargs) > 10]
    assert many == []


def test_every_file_of_the_engine_is_in_a_room_or_its_face():
    assert {path.stem for path in ENGINE.glob("*.py")} == FACE
    assert {path.name for path in ENGINE.iterdir() if list(path.glob("*.py"))} == ROOMS


def test_no_table_travels_beside_the_state_that_holds_it():
    beside = []
    for path, f in functions():
        types = {a.arg: ast.unparse(a.annotation) for a in f.args.args if a.annotation is not None}
        if "State" in types.values():
            beside += [
                f"{path.name}: {f.name}({name})" for name, kind in types.items() if kind == "Table" and name != "ledger"
            ]
    assert beside == []


def calls_of(act: Callable[[], Any]) -> list[str]:
    """The functions of the package that Python calls, and the kernels."""
    calls: list[str] = []

    def note(frame: Any, event: str, _: Any) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(str(PACKAGE)):
            calls.append(f"{Path(frame.f_code.co_filename).stem}.{frame.f_code.co_name}")

    sys.setprofile(note)
    try:
        act()
    finally:
        sys.setprofile(None)
    return calls


compiled = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="counts the calls of compiled code")


@compiled
def test_an_advance_in_which_nothing_happens_takes_six_calls():
    world = World(Scene(gravity=(0.0, -9.81), ball=Ball(radius=0.1), elements=(Wall((0.0, 0.0), (1.0, 0.0)),)))
    world.reset(position=(0.5, 0.9), velocity=(0.0, 0.0))
    world.advance(0.001)
    calls = calls_of(lambda: world.advance(0.001))
    assert 1 <= len(calls) <= 6, calls


@compiled
@pytest.mark.parametrize("game", ["Paddle", "Pinball", "Walls"])
def test_a_step_of_an_environment_takes_twelve_calls(game: str):
    env = gym.make(f"Bounce/{game}-v0", disable_env_checker=True).unwrapped
    env.reset(seed=0)
    action = env.action_space.sample() * 0
    for _ in range(3):
        env.step(action)
    calls = calls_of(lambda: env.step(action))
    assert 1 <= len(calls) <= 12, calls
