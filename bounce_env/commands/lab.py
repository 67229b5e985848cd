"""`lab`."""

import webbrowser
from pathlib import Path

from bounce_env.commands.cli import FINE, Refused, check_range, say
from bounce_env.lab.guard import LOCAL
from bounce_env.lab.kernels import Kernels
from bounce_env.lab.server import Server
from bounce_env.scene import SceneError, load_scene


def run_lab(room: str | None, scene: str | None, *, folder: Path, host: str, port: int, show: bool) -> int:
    """Serve the lab until Ctrl-C."""
    check_range("port", port, 0, 65_535)
    if not folder.is_dir():
        raise Refused(f"--folder {folder}: must be a folder that is there")
    if scene is not None:
        try:
            load_scene(scene)
        except SceneError as error:
            raise Refused(str(error)) from error
    kernels = Kernels()
    try:
        _serve(kernels, room, scene, folder=folder, host=host, port=port, show=show)
    finally:
        kernels.close()
    return FINE


def run_benchmark() -> int:
    """Measure the stage in a browser, and say what came out."""
    from bounce_env.lab.benchmark import SIZE, WALLS, benchmark, browser_path  # noqa: PLC0415 (Playwright is no extra)

    executable = browser_path()
    if executable is None:
        raise Refused("--benchmark: needs Chromium or Chrome, which is not on the path")
    found = benchmark(executable)
    say(
        f"{WALLS} walls at {SIZE['width']} x {SIZE['height']}: {found.frames:.1f} frames/s of the browser, "
        f"{found.shown:.1f} of the stage; from a drag to the frame that shows it {found.median:.0f} ms, "
        f"95 % within {found.p95:.0f} ms"
    )
    return FINE


def _serve(
    kernels: Kernels, room: str | None, scene: str | None, *, folder: Path, host: str, port: int, show: bool
) -> None:
    try:
        server = Server(folder=folder, scene=scene, host=host, port=port, ready=kernels.wait)
    except OSError as error:
        raise Refused(f"--host {host} --port {port}: cannot be listened to: {error.strerror}") from error
    if host not in LOCAL:
        say(f"warning: whoever reaches {host} and knows the address below can use this lab, unencrypted")
    address = server.address(room or "")
    say(f"{address}\nScenes are read from and saved to {folder.resolve()}. Ctrl-C ends the lab.")
    if show:
        webbrowser.open(address)
    server.run()
