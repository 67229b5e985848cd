"""`scenes list` and `scenes draw`."""

import os
from collections import Counter
from pathlib import Path

import numpy as np

from bounce_env.commands.cli import FINE, PROBLEMS, Refused, say
from bounce_env.files import replacing
from bounce_env.scene import Scene, SceneError, builtin_scenes, load_scene
from bounce_env.wording import counted, nearest


def list_scenes() -> int:
    """Print a line for each built-in scene."""
    scenes = {name: load_scene(name) for name in builtin_scenes()}
    width = max(map(len, scenes))
    for name, scene in scenes.items():
        say(f"{name:<{width}}  {outline(scene)}")
    return FINE


def outline(scene: Scene) -> str:
    """Return a scene in a few words: its size [m] and how many elements of each kind it has."""
    left, bottom, right, top = scene.bounds
    kinds = Counter(type(element).__name__.lower() for element in scene.elements)
    counts = (counted(count, kind) for kind, count in kinds.items())
    return f"{right - left:g} x {top - bottom:g} m: {', '.join(counts) or 'no elements'}"


def check_named(source: str) -> None:
    """Raises Refused where `source` is neither the path of a file nor the name of a built-in scene."""
    if is_path(source) and not Path(source).is_file():
        why = "is a folder, must be a .toml file" if Path(source).is_dir() else "there is no such file"
        raise Refused(f"scene {source!r}: {why}")
    if not is_path(source) and source not in builtin_scenes():
        known, hint = ", ".join(builtin_scenes()), nearest(source, builtin_scenes())
        raise Refused(f"scene {source!r}: must be one of {known}, or the path of a .toml file{hint}")


def is_path(source: str) -> bool:
    """Return whether a scene is given as the path of a file, not by a built-in's name."""
    return source.endswith(".toml") or "/" in source or os.sep in source


def draw_scene(source: str, output: Path | None, width: int | None, height: int | None) -> int:
    """Write the picture of a scene, parts where they are after a reset, to `output`; None for beside the scene."""
    from bounce_env.engine.placement import part_cores_at_start  # noqa: PLC0415 (imports numba: after what is quick to refuse)
    from bounce_env.render import Picture, Renderer  # noqa: PLC0415
    from bounce_env.render.lazy_pygame import load_pygame  # noqa: PLC0415

    check_named(source)
    if output is None:
        output = Path(source).with_suffix(".png") if is_path(source) else Path(f"{source}.png")
    if output.suffix.lower() != ".png":
        raise Refused(f"--output {output}: must end in .png")
    if not output.parent.is_dir():
        raise Refused(f"--output {output}: there is no folder {output.parent}")
    try:
        scene = load_scene(source)
    except SceneError as error:
        say(str(error))
        return PROBLEMS
    try:
        renderer = Renderer(scene, width, height)
    except ValueError as error:
        raise Refused(f"--{error}") from error
    cores = np.array([*part_cores_at_start(scene).values()]).reshape(-1, 4)
    frame = renderer.frame(Picture(balls=(), cores=cores))
    pygame = load_pygame()
    image = pygame.image.frombuffer(frame, (frame.shape[1], frame.shape[0]), "RGB")
    try:
        with replacing(output) as unfinished:
            pygame.image.save(image, str(unfinished))
    except (OSError, pygame.error) as error:
        raise Refused(f"--output {output}: cannot be written: {error}") from error
    say(f"{output}: {frame.shape[1]} x {frame.shape[0]} pixels")
    return FINE
