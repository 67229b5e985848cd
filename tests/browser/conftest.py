"""A real browser, driven by real mouse, touch and key events, and a lab that serves it."""

from contextlib import contextmanager

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

from bounce_env.lab.benchmark import browser_path
from bounce_env.lab.kernels import compile_wanted
from bounce_env.lab.play import GAMES
from bounce_env.lab.ready import DISC, POINT, Wanted
from tests.conftest import require
from tests.lab.serving import serving

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]
WIDE, NARROW = {"width": 1280, "height": 900}, {"width": 400, "height": 800}


@pytest.fixture(scope="module")
def browser():
    """Chromium or Chrome, of the machine."""
    path = browser_path()
    require("browser", path is not None, "Chromium or Chrome on the path")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield running
        running.close()


@contextmanager
def page_of(browser, **context):
    """Give a page; a message on its console, an error in it or a request to elsewhere fails the test."""
    opened = browser.new_context(**{"viewport": WIDE, **context})
    page, complaints = opened.new_page(), []
    page.set_default_timeout(20_000)
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("requestfailed", lambda request: complaints.append(f"{request.url}: {request.failure}"))
    page.on("dialog", lambda dialog: complaints.append(dialog.message))
    yield page
    assert complaints == []
    opened.close()


@pytest.fixture(scope="session")
def kernels():
    """All that the lab needs, compiled: what a test waits for is then the page."""
    for wanted in (POINT, DISC, *map(Wanted, GAMES.values())):
        compile_wanted(wanted)


@pytest.fixture(scope="module")
def lab(browser, kernels, tmp_path_factory):
    """A lab, with a folder of its own."""
    folder = tmp_path_factory.mktemp("scenes")
    with serving(folder) as server:
        server.folder = folder
        yield server


def check_that_everyone_can_use(page):
    """No serious problem that axe finds, and nothing is cut off at the page's width."""
    found = Axe().run(page).response["violations"]
    bad = [
        (rule["id"], [node["target"] for node in rule["nodes"]])
        for rule in found
        if rule["impact"] in ("serious", "critical")
    ]
    assert bad == []
    assert page.evaluate("document.documentElement.scrollWidth") <= page.viewport_size["width"]
