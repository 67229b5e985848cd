"""Frames a second of the stage, and how long a drag takes to be seen: in a real browser, physics in the loop."""

import math
import shutil
import statistics
import tempfile
import threading
from pathlib import Path
from typing import Any, NamedTuple

from playwright.sync_api import Page, sync_playwright

from bounce_env.lab.kernels import Kernels
from bounce_env.lab.server import Server
from bounce_env.scene import Ball, Scene, Wall, dump_scene

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
SIZE = {"width": 1280, "height": 720}
WALLS = 200
SECONDS = 5.0
DRAGS = 100
CIRCLE = 8.0
"""Pixels about which an end is dragged: less than a wall is long, so that it follows."""

_COUNT = """
(seconds) => new Promise((resolve) => {
  const frames = [];
  let shown = 0;
  document.addEventListener("drawn", () => { shown += 1; });
  const frame = (at) => {
    frames.push(at);
    if (at - frames[0] < 1000 * seconds) requestAnimationFrame(frame);
    else resolve([frames, shown]);
  };
  requestAnimationFrame(frame);
})
"""

_WATCH = """
() => {
  window.delays = [];
  let asked = null;
  document.getElementById("canvas").addEventListener("pointermove", (event) => { asked ??= event.timeStamp; });
  let before = null;
  document.addEventListener("drawn", ({ detail }) => {
    const ends = JSON.stringify(detail.parts.find(([index]) => index === 4));
    if (asked && before !== null && ends !== before) {
      const began = asked;
      requestAnimationFrame(() => window.delays.push(performance.now() - began)); // this frame shows what is drawn
      asked = null;
    }
    before = ends;
  });
}
"""


class Figures(NamedTuple):
    """What was measured. frames, shown: of the browser, and pictures of the stage, a second; delays: of drags [ms]."""

    frames: float
    shown: float
    median: float
    p95: float


def browser_path() -> str | None:
    """Return the path of a Chromium, or None."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def many_walls() -> Scene:
    """Return a closed box with a ball and 200 walls in all, in rows."""
    size = 14
    walls = [Wall(a, b) for a, b in (((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0)))]
    for k in range(WALLS - len(walls)):
        x, y = 0.06 + 0.88 * (k % size) / (size - 1), 0.06 + 0.82 * (k // size) / size
        turn, half = 0.7 * k, 0.018
        dx, dy = half * math.cos(turn), half * math.sin(turn)
        walls.append(Wall((x - dx, y - dy), (x + dx, y + dy)))
    return Scene(gravity=(0.0, -1.0), ball=Ball(0.008), elements=tuple(walls))


def benchmark(executable: str) -> Figures:
    """Measure on a server and in a browser of its own."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "walls.toml"
        scene.write_text(dump_scene(many_walls()), encoding="utf-8")
        kernels = Kernels()
        server = Server(folder=Path(folder), scene=str(scene), ready=kernels.wait)
        thread = threading.Thread(target=server.run)
        thread.start()
        try:
            return _measured(server.address("stage"), executable)
        finally:
            server.stop()
            thread.join()
            kernels.close()


def _measured(address: str, executable: str) -> Figures:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=["--no-sandbox"])
        page = browser.new_page(viewport=SIZE)  # type: ignore[arg-type]
        page.goto(address)
        page.wait_for_selector("#elements option", state="attached", timeout=600_000)  # until all is compiled
        page.click("#play")
        page.wait_for_timeout(1000)
        times, shown = page.evaluate(_COUNT, SECONDS)
        delays = _drag(page)
        browser.close()
    seconds = (times[-1] - times[0]) / 1000.0
    p95 = statistics.quantiles(delays, n=20)[-1]
    return Figures((len(times) - 1) / seconds, shown / seconds, statistics.median(delays), p95)


def _drag(page: Page) -> Any:
    """Drag an end about; returns how long each time took until it was seen to move [ms]."""
    page.evaluate(_WATCH)
    page.select_option("#elements", "4")
    box = page.locator(".handle").first.bounding_box()
    assert box is not None
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
    page.focus("#canvas")
    page.evaluate(
        "() => document.querySelectorAll('.handle').forEach((handle) => { handle.style.pointerEvents = 'none'; })"
    )
    page.mouse.move(x, y)
    page.mouse.down()
    for k in range(DRAGS):
        page.mouse.move(x + CIRCLE * math.sin(0.7 * k), y + CIRCLE * math.cos(0.7 * k))
        page.wait_for_timeout(100)
    page.mouse.up()
    return page.evaluate("window.delays")
