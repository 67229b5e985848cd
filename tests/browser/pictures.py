"""Make the pictures of the lab that README and docs show: `make pictures`."""

import io
import math
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from bounce_env.lab.benchmark import browser_path
from tests.browser.conftest import ARGUMENTS
from tests.lab.serving import serving

FOLDER = Path(__file__).parents[2] / ".github"
FRAMES = 60
MILLISECONDS = 70  # of a frame; the page goes on meanwhile
COLOURS = 48


def main() -> None:
    """Write the pictures into `.github`."""
    path = browser_path()
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder)) as server, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1280, "height": 860})
        page.goto(server.address("reflection"))
        page.wait_for_selector("#numbers tr")
        Image.open(io.BytesIO(page.screenshot())).quantize(128).save(FOLDER / "lab_reflection.png", optimize=True)
        page.goto(server.address("stage").partition("?")[0])
        page.wait_for_selector("#elements option", state="attached", timeout=600_000)
        pictures = list(_stage(page))
        page.goto(server.address("play").partition("?")[0])
        page.wait_for_selector("#words:has-text('to start')", timeout=600_000)
        page.keyboard.press("Space")
        page.wait_for_timeout(6000)
        Image.open(io.BytesIO(page.screenshot())).quantize(64).save(FOLDER / "lab_play.png", optimize=True)
        browser.close()
    small = [picture.quantize(COLOURS, dither=Image.Dither.NONE) for picture in pictures]
    small[0].save(
        FOLDER / "lab_stage.gif", save_all=True, append_images=small[1:], duration=MILLISECONDS, loop=0, optimize=True
    )


def _stage(page):
    """Drag an end of a wall about while the ball runs; yields pictures of the stage."""
    page.select_option("#elements", "6")
    page.click("#ghost")
    page.click("#play")
    box = page.locator(".handle >> nth=0").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for k in range(FRAMES):
        angle = 2.0 * math.pi * k / FRAMES
        page.mouse.move(x + 70.0 * math.sin(angle), y + 70.0 * math.sin(2.0 * angle))
        page.wait_for_timeout(MILLISECONDS)
        yield Image.open(io.BytesIO(page.locator("#board").screenshot())).convert("RGB").reduce(1)
    page.mouse.up()


if __name__ == "__main__":
    main()
