"""A game in the browser, from its start to its end, by keys, mouse and fingers."""

import re

import pytest

from bounce_env import load_replay
from tests.browser.conftest import page_of

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def own_scores(tmp_path, monkeypatch):
    """High scores of the test, not of whoever runs it."""
    monkeypatch.setattr("bounce_env.lab.scores.user_data_path", lambda name: tmp_path / name)


def opened(page, lab, game):
    page.goto(lab.address("play"))
    page.wait_for_selector("#hud:has-text('Score')", timeout=600_000)  # the first compiles
    if game != "pinball":
        page.select_option("#game", game)
        page.wait_for_selector(
            f"#controls:has-text('{'paddle follows' if game == 'paddle' else 'end of the wall'}')", timeout=600_000
        )
    page.wait_for_selector("#words:has-text('to start')")
    return page


def hud(page):
    return page.locator("#hud").inner_text()


def test_a_game_is_played_to_its_end_begun_anew_and_saved(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "paddle")
        page.keyboard.press("Space")
        page.keyboard.down("ArrowRight")
        page.wait_for_selector("#words:has-text('Game over: drained')", timeout=60_000)
        page.keyboard.up("ArrowRight")
        score = re.search(r"Score (\d+)", page.locator("#words").inner_text())[1]
        assert f"Best {score}" in hud(page)
        page.fill("#name", "played")
        page.click("#save")
        page.wait_for_selector("#notice:has-text('played.html')")
        assert load_replay(lab.folder / "played.html").document["about"]["id"] == "Bounce/Paddle-v0"
        page.locator("#canvas").focus()
        page.keyboard.press("r")
        page.wait_for_selector("#words:empty", state="attached")


def test_pinball_pauses_and_fingers_press_flippers(browser, lab):
    with page_of(browser, has_touch=True) as page:
        opened(page, lab, "pinball")
        assert "Ball 1 of 3" in hud(page)
        box = page.locator("#canvas").bounding_box()
        page.touchscreen.tap(box["x"] + 0.25 * box["width"], box["y"] + 0.8 * box["height"])
        page.wait_for_selector("#words:empty", state="attached")
        page.wait_for_timeout(700)
        page.locator("#canvas").focus()
        page.keyboard.press("p")
        assert "Paused" in page.locator("#words").inner_text()
        before = hud(page)
        page.wait_for_timeout(700)
        assert hud(page) == before
        page.keyboard.press("p")
        page.wait_for_timeout(1500)
        assert hud(page) != before


def test_an_end_of_the_wall_is_drawn_by_the_mouse(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "walls")
        box = page.locator("#canvas").bounding_box()
        page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.6 * box["height"])
        page.mouse.down()
        page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"], steps=5)
        page.wait_for_timeout(1000)
        page.mouse.up()
        assert "of 5" in hud(page)  # the first ball, or the second where that one was quick
        assert page.locator("#words").inner_text() == ""
