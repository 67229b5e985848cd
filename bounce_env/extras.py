"""The package's extras: what a missing one is told by, with a command that installs it."""

import json
import os
import shlex
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from urllib.parse import unquote, urlparse
from urllib.request import url2pathname

from gymnasium.error import DependencyNotInstalled

CPU_TORCH = "https://download.pytorch.org/whl/cpu"

WITH_TORCH = ("sb3", "train", "test", "dev")
"""Extras that install PyTorch."""


class MissingExtraError(DependencyNotInstalled, ImportError):
    """An extra of the package that is not installed: Gymnasium's error for it, and an ImportError."""


def missing(extra: str, module: str, needs: str) -> MissingExtraError:
    """The error that says what needs an extra ("drawing needs"), what of it is missing, and how it is installed."""
    small = f" (without a GPU first: {cpu_torch_command()})" if extra in WITH_TORCH else ""
    return MissingExtraError(
        f"{needs} {module}, which is not installed. Install the extra {extra!r}: {install_command(extra)}{small}"
    )


def cpu_torch_command() -> str:
    """Return a line for a shell that installs PyTorch's build for the CPU, which is a tenth of the one for GPUs."""
    return f"{_quoted(sys.executable or 'python')} -m pip install torch --index-url {CPU_TORCH}"


def install_command(extra: str) -> str:
    """Return a line for a shell that installs an extra for the Python that is running.

    From a clone, or another folder that the package was installed from (`direct_url.json`, PEP 610), in that folder.
    """
    pip = f"{_quoted(sys.executable or 'python')} -m pip install"
    folder, editable = source_folder()
    if folder is None:
        return f'{pip} "bounce_env[{extra}]"'
    return f'cd {_quoted(str(folder))} && {pip} {"-e " if editable else ""}".[{extra}]"'


def _quoted(word: str) -> str:
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)


def source_folder() -> tuple[Path | None, bool]:
    """The folder that the package was installed from, or is run from, and whether it is used as it lies there."""
    here = Path(__file__).resolve().parent.parent
    try:
        text = metadata.distribution("bounce_env").read_text("direct_url.json")
    except metadata.PackageNotFoundError:  # run from a clone without being installed
        return (here, True) if (here / "pyproject.toml").is_file() else (None, False)
    origin = json.loads(text) if text else {}
    url = urlparse(origin.get("url", ""))
    folder = Path(url2pathname(unquote(url.path))) if url.scheme == "file" and "dir_info" in origin else None
    if folder is None or not (folder / "pyproject.toml").is_file():
        return None, False
    return folder, bool(origin["dir_info"].get("editable", False))


def version() -> str:
    """Return the version of the package, as it was installed."""
    try:
        return metadata.version("bounce_env")
    except metadata.PackageNotFoundError:
        return "unknown (not installed)"
