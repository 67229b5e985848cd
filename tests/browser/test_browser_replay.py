"""Replays as a person opens them: from a file, and two in a notebook."""

from pathlib import Path

import pytest

from bounce_env import load_replay
from tests.browser.conftest import NARROW, WIDE, check_that_everyone_can_use, page_of
from tests.browser.shots import compare

pytestmark = pytest.mark.slow

STORED = Path(__file__).parents[1] / "replay" / "stored" / "v1.json"


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    return load_replay(STORED).save(tmp_path_factory.mktemp("replay") / "run.html").as_uri()


def clock(page):
    return float(page.locator("#clock").inner_text().removesuffix(" s"))


def test_a_replay_plays_stops_and_goes_from_event_to_event(browser, address):
    with page_of(browser) as page:
        page.goto(f"{address}#0.3")
        assert clock(page) == 0.3
        compare(page.locator("#scene"), "replay")
        page.click("#play")
        page.wait_for_timeout(500)
        page.click("#play")
        assert 0.5 < clock(page) < 1.6
        page.locator("#time").focus()
        page.keyboard.press("Home")
        assert clock(page) == 0.0
        times = []
        for _ in range(4):
            page.click("#forth")
            times.append(clock(page))
        assert times == sorted(times)
        assert times[-1] > 0.0
        page.click("#back")
        assert clock(page) == times[-2]
        page.locator("#scene").focus()
        page.keyboard.press(".")
        assert clock(page) == times[-1]
        page.select_option("#speed", "0.001")
        page.click("#play")
        page.wait_for_timeout(500)
        page.click("#play")
        assert times[-1] < clock(page) < times[-1] + 0.002
        names = page.locator("#events option").all_inner_texts()
        assert any("</script><script>alert(1)</script>" in name for name in names)
        page.mouse.move(*centre(page.locator("#scene").bounding_box()))
        assert "pointer: " in page.locator("#values").inner_text()
        assert "score: 10" in page.locator("#values").inner_text() or clock(page) < 0.2


def centre(box):
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_two_replays_in_a_notebook_do_not_meddle(browser, tmp_path):
    frame = load_replay(STORED)._repr_html_()
    notebook = tmp_path / "notebook.html"
    notebook.write_text(f"<!doctype html><meta charset=utf-8><title>Notebook</title>{frame}{frame}", encoding="utf-8")
    with page_of(browser) as page:
        page.goto(notebook.as_uri())
        one, other = page.frames[1:]
        one.wait_for_selector("#events option", state="attached")
        other.wait_for_selector("#events option", state="attached")
        for _ in range(3):
            one.click("#forth")
        assert clock(one) > 0.0
        assert clock(other) == 0.0


def test_a_replay_in_an_output_that_is_folded_is_there_when_it_is_opened(browser, tmp_path):
    frame = load_replay(STORED)._repr_html_()
    notebook = tmp_path / "notebook.html"
    notebook.write_text(
        f"<!doctype html><meta charset=utf-8><title>Notebook</title><div hidden>{frame}</div>", encoding="utf-8"
    )
    with page_of(browser) as page:
        page.goto(notebook.as_uri())
        inside = page.frames[1]
        inside.wait_for_selector("#events option", state="attached")
        page.evaluate("document.querySelector('div').hidden = false")
        # The canvas follows the frame's size, which it is told of a moment later.
        inside.wait_for_selector("#scene:visible")
        for _ in range(50):
            if inside.locator("#scene").bounding_box()["width"] > 200.0:
                break
            page.wait_for_timeout(100)
        assert inside.locator("#scene").bounding_box()["width"] > 200.0
        inside.click("#forth")
        assert clock(inside) > 0.0


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_everyone_can_use_it_and_nothing_is_cut_off(browser, address, scheme):
    for size in (WIDE, NARROW):
        # What looks for problems is run in the page, which its policy forbids.
        with page_of(browser, viewport=size, color_scheme=scheme, bypass_csp=True) as page:
            page.goto(address)
            check_that_everyone_can_use(page)
