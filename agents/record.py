"""Record an episode: `python -m agents.record`."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import gymnasium as gym
import imageio_ffmpeg
import numpy as np
import numpy.typing as npt
import tyro
from PIL import Image

from agents.command import JsonObject, Refused, check_range, run, say
from agents.files import replacing
from agents.look_ahead import LookAhead, act
from agents.players import named
from agents.task import HELD_OUT, Player, Task

Frame = npt.NDArray[np.uint8]  # (height, width, 3)

GIF_COLOURS = 64
GIF_STRIDE = 2  # every second frame at half the size: a GIF is for a page, the MP4 for looking closely


def play(env: gym.Env[Any, Any], player: Player | LookAhead, seed: int) -> Iterator[None]:
    """Play the first episode of `seed`; stops at its launch and after each step."""
    observation, _ = env.reset(seed=seed)
    ended = False
    yield
    while not ended:
        action: Any = act(player, observation[None], env.unwrapped.clone_state)[0]
        observation, _, terminated, truncated, _ = env.step(action)
        ended = terminated or truncated
        yield


def frames(task: Task, player: Player | LookAhead, seed: int) -> Iterator[Frame]:
    """Return the frames of the first episode of `seed`, from its launch to its end."""
    env = task.single(render_mode="rgb_array")
    for _ in play(env, player, seed):
        yield np.asarray(env.render())
    env.close()


def write_mp4(path: Path, pictures: Iterable[Frame], fps: float) -> list[Image.Image]:
    """Encode an episode frame by frame, and keep what the GIF needs of it: a long one would not fit into memory."""
    kept: list[Image.Image] = []
    encoder = None
    with replacing(path) as unfinished:
        for k, picture in enumerate(pictures):
            if encoder is None:
                height, width, _ = picture.shape
                # Sizes that are odd are scaled to even ones, as H.264 needs them.
                encoder = imageio_ffmpeg.write_frames(unfinished, (width, height), fps=fps, macro_block_size=2)
                encoder.send(None)
            encoder.send(picture)
            if k % GIF_STRIDE == 0:
                small = Image.fromarray(picture).reduce(GIF_STRIDE)
                kept.append(small.quantize(GIF_COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE))
        if encoder is not None:
            encoder.close()
    return kept


def write_gif(path: Path, pictures: list[Image.Image], fps: float) -> None:
    """A GIF that repeats for ever."""
    # A GIF counts in 1/100 s: rounding each instant, and not each duration, keeps the whole at the right speed.
    instants = np.round(np.arange(len(pictures) + 1) * 100.0 / fps).astype(int)
    with replacing(path) as unfinished:
        pictures[0].save(
            unfinished,
            save_all=True,
            append_images=pictures[1:],
            duration=(np.diff(instants) * 10).tolist(),  # ms
            loop=0,
        )


def record_episode(task: Task, player: Player | LookAhead, folder: Path, seed: int = HELD_OUT) -> list[Path]:
    """Write rollout.mp4 and rollout.gif of the first episode of `seed`, at the speed of play."""
    made_folder(folder)
    fps = task.single().metadata["render_fps"]
    mp4, gif = folder / "rollout.mp4", folder / "rollout.gif"
    pictures = write_mp4(mp4, frames(task, player, seed), fps)
    write_gif(gif, pictures, fps / GIF_STRIDE)
    return [mp4, gif]


def record_replay(task: Task, player: Player | LookAhead, folder: Path, seed: int = HELD_OUT) -> Path:
    """Write rollout.html, the replay of the first episode of `seed`."""
    env = task.single(record_events=True)
    for _ in play(env, player, seed):
        pass
    return env.unwrapped.replay().save(made_folder(folder) / "rollout.html")


def made_folder(folder: Path) -> Path:
    """Return the folder, which is there now; raises Refused where it cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Refused(f"--output {folder}: cannot be made: {error.strerror}") from error
    return folder


@dataclass(frozen=True)
class RecordOptions:
    """See `record`."""

    player: Annotated[str, tyro.conf.Positional]
    """A run folder (runs/...) or the name of a baseline: random, follow, predictor."""
    seed: int = HELD_OUT
    """Of the episode; evaluation plays those from 10000 on."""
    sampled: bool = False
    """Let a trained agent sample its actions, instead of taking the best."""
    html: bool = False
    """Write rollout.html in place of the film: a page that plays the episode at any speed, from event to event."""
    output: Path | None = None
    """Folder to write into. Default: the run folder; runs/NAME for a baseline."""
    env_id: str | None = None
    """What to play. Default: what the run was trained on; Bounce/Paddle-v0 for a baseline."""
    env_kwargs: JsonObject = None
    """Keyword arguments of the environment, such as {"width": 800}. Default: those of the run; none for a baseline."""


def record(options: RecordOptions) -> int:
    """Film an episode: rollout.mp4, and rollout.gif at half the size, both at the speed of play.

    A model file can run code when it is loaded: record only runs that you trust.
    """
    check_range("seed", options.seed, 0)
    task, players = named(options.player, options.env_id, options.env_kwargs)
    player = list(players.values())[-1 if options.sampled else 0]
    default = Path(options.player) if Path(options.player).is_dir() else Path("runs") / options.player
    folder = options.output or default
    if options.html:
        say(str(record_replay(task, player, folder, options.seed)))
    else:
        for path in record_episode(task, player, folder, options.seed):
            say(str(path))
    return 0


if __name__ == "__main__":
    run(record, RecordOptions)
