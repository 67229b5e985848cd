"""The pictures that pages show: films of trained agents, and elements with the way of a ball among them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from PIL import Image

import bounce_env
from bounce_env import Scene, World, plot_scene
from bounce_env.render import Picture, Renderer

MADE = Path(__file__).resolve().parent.parent / "_made"
"""Nothing in it is kept in the repository."""

_SEEDS = {"Bounce/Pinball-v0": 7, "Bounce/Paddle-v0": 1, "Bounce/Walls-v0": 3}
_FRAMES, _EVERY = 150, 2  # steps of 1/30 s; of these one in two is shown
_LARGEST = 420  # pixels of a film's longer side


def film(env_id: str) -> str:
    """Draw a trained agent's play of ten seconds as a GIF; return its address as pages write it."""
    agent = bounce_env.load_agent(env_id)
    env = gym.make(env_id, render_mode="rgb_array", trail=0.3, **agent.env_kwargs)
    observation, _ = env.reset(seed=_SEEDS[env_id])
    frames = []
    for k in range(2 * _FRAMES):
        observation, _, terminated, truncated, _ = env.step(agent(observation))
        if k % _EVERY == 0:
            frames.append(_small(env.render()))
        if terminated or truncated:
            break
    env.close()
    name = f"{env_id.removeprefix('Bounce/').lower()}.gif"
    _write_gif(name, frames, 1000 * _EVERY // 30)
    return f"/_made/{name}"


def _small(frame: npt.NDArray[np.uint8]) -> Image.Image:
    picture = Image.fromarray(frame)
    share = _LARGEST / max(picture.size)
    return picture.resize((round(share * picture.width), round(share * picture.height)), Image.Resampling.LANCZOS)


def _write_gif(name: str, frames: Sequence[Image.Image], milliseconds: int) -> None:
    MADE.mkdir(exist_ok=True)
    some = np.concatenate([np.asarray(frame) for frame in frames[:: max(1, len(frames) // 12)]])
    palette = Image.fromarray(some).quantize(256, Image.Quantize.MEDIANCUT)  # one for all frames: nothing flickers
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    first.save(MADE / name, save_all=True, append_images=others, duration=milliseconds, loop=0, optimize=False)


def element_picture(
    name: str,
    scene: Scene,
    position: Sequence[float],
    velocity: Sequence[float],
    seconds: float,
    command: Any,
) -> str:
    """Draw a scene with the way of a ball through it; return the picture's address as pages write it.

    position [m], velocity [m/s]: of the ball at first. command: what the only part is told then; None: nothing.
    """
    world = World(scene)
    world.record()
    world.reset(position=position, velocity=velocity)
    if command is not None:
        world.command(scene.parts[0][1].name, command)
    times = np.linspace(0.0, seconds, 1200)
    way = [world.position[0]]
    for step in np.diff(times):
        world.advance(float(step))
        way.append(world.position[0])
    trail = np.column_stack([np.array(way), np.linspace(0.15, 1.0, len(way))])
    frame = Renderer(scene, 440, 300).frame(Picture(balls=world.position, cores=world.cores, trail=trail))
    MADE.mkdir(exist_ok=True)
    Image.fromarray(frame).save(MADE / f"element_{name}.png")
    return f"/_made/element_{name}.png"


def scene_picture(name: str) -> str:
    """Draw a built-in scene with its coordinates; return the picture's address as pages write it."""
    scene = bounce_env.load_scene(name)
    left, bottom, right, top = scene.bounds
    share = 4.2 / max(right - left, top - bottom)
    sides = (0.9 + max(share * side, 0.6) for side in (right - left, top - bottom))  # a floor alone has no height
    figure = Figure(figsize=tuple(sides), layout="constrained")
    axes = plot_scene(scene, figure.add_subplot())
    axes.set_aspect("equal", adjustable="datalim")  # what has no height leaves the picture its own
    axes.grid(linewidth=0.3)
    axes.tick_params(labelsize=7)
    MADE.mkdir(exist_ok=True)
    figure.savefig(MADE / f"scene_{name}.png", dpi=110)
    return f"/_made/scene_{name}.png"
