"""`doctor`: what a bug report needs to say of the machine."""

import importlib.metadata
import os
import platform
import shutil
import sys
from pathlib import Path

import bounce_env
from bounce_env.commands.cli import FINE, say
from bounce_env.extras import install_command, version
from bounce_env.machine import processor

PACKAGES = {
    "": ("gymnasium", "numpy", "numba", "llvmlite", "pydantic"),
    "render": ("pygame-ce",),
    "cli": ("tyro", "tqdm", "imageio-ffmpeg"),
    "sb3": ("stable-baselines3", "torch"),
    "report": ("pymunk", "Box2D", "scipy", "mpmath", "matplotlib", "jinja2"),
}
"""By the extra that installs them; "" for what is always there."""


def diagnose() -> int:
    """Print versions, processor, cache folder, display and ffmpeg, a line each."""
    say(f"bounce_env         {version()}, in {Path(bounce_env.__file__).parent}")
    say(f"python             {platform.python_version()}, {sys.executable}")
    say(f"system             {platform.platform()}")
    say(f"processor          {processor()}, {os.cpu_count()} threads")
    for extra, packages in PACKAGES.items():
        for package in packages:
            say(f"{package:<18} {_version_of(package) or f'not installed: {install_command(extra)}'}")
    say(f"kernel cache       {_cache()}")
    say(f"display            {_display()}")
    say(f"ffmpeg             {_ffmpeg()}")
    return FINE


def _version_of(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def _cache() -> str:
    from bounce_env.engine.compile.cache import cache_folder  # noqa: PLC0415
    from bounce_env.engine.world_kernels import world_advance  # noqa: PLC0415

    folder = cache_folder(world_advance)
    if folder is None:
        return "none that can be written: kernels are compiled in each process; set NUMBA_CACHE_DIR"
    kernels = len(list(Path(folder).glob("*.nbc")))
    return f"{folder} ({kernels} kernels of the engine)"


def _display() -> str:
    try:
        from bounce_env.render.window import display_problem  # noqa: PLC0415
    except ImportError:
        return "not known: pygame is not installed"
    return display_problem() or os.environ.get("SDL_VIDEODRIVER") or "there is one"


def _ffmpeg() -> str:
    try:
        import imageio_ffmpeg  # noqa: PLC0415

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return shutil.which("ffmpeg") or "none: films cannot be made"
