"""The lab as a person uses it."""

import re

import pytest

from bounce_env import load_scene
from tests.browser.conftest import NARROW, WIDE, check_that_everyone_can_use, page_of
from tests.browser.shots import compare

pytestmark = pytest.mark.slow

ROOMS = ("", "reflection", "stage", "play")


def opened(page, lab, room):
    page.goto(lab.address(room))
    if room == "reflection":
        page.wait_for_selector("#numbers tr")
    if room == "play":
        page.wait_for_selector("#words:has-text('to start')", timeout=600_000)
    if room == "stage":
        page.wait_for_selector("#elements option", state="attached", timeout=600_000)  # a first one compiles
    return page


def centre(page, selector):
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def until(page, holds):
    """Wait until something holds; the page's policy forbids to ask it there."""
    for _ in range(100):
        if holds():
            return
        page.wait_for_timeout(100)
    raise AssertionError("it has not come to hold within 10 s")


def results(page):
    return page.locator("#numbers tr td:nth-child(3)").all_inner_texts()


def test_an_end_of_a_vector_is_dragged_by_mouse_and_the_numbers_follow(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "reflection")
        before = results(page)
        compare(page.locator("#board"), "reflection")
        x, y = centre(page, ".grip >> nth=1")
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x - 40, y - 60, steps=4)
        page.mouse.up()
        until(page, lambda: results(page)[0] != before[0])
        after = results(page)
        assert after[0] != before[0]
        assert after[1] == before[1]  # the wall
        label = page.locator(".grip >> nth=1").get_attribute("aria-label")
        assert re.fullmatch(r"Movement, end: -?[\d.]+, -?[\d.]+", label)


def test_an_end_is_moved_by_the_arrow_keys_and_b_halves_the_way_back(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "reflection")
        page.locator(".grip >> nth=0").focus()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("Shift+ArrowUp")
        page.wait_for_selector('[aria-label="Movement, start: -2.55, 2.70"]')
        page.fill("#wall_b", "0")
        page.wait_for_selector('td:has-text("+ 0·")')
        normal = page.locator("#numbers tr:nth-child(10) td:nth-child(3)").inner_text()
        assert normal.endswith("6.34019°")  # along the wall


def test_a_wall_is_dragged_while_the_ball_runs_and_paused(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "stage")
        page.select_option("#elements", "6")
        start = end_of(page)
        page.click("#play")
        drag(page, ".handle >> nth=0", 50, 30)
        page.click("#play")
        moved = end_of(page)
        assert moved != start
        assert page.locator("#undo").is_enabled()
        drag(page, ".handle >> nth=0", -50, -30)
        assert end_of(page) == pytest.approx(start, abs=0.02)
        page.locator(".handle >> nth=0").focus()
        page.keyboard.press("ArrowUp")
        page.wait_for_timeout(300)
        assert end_of(page)[1] > start[1]
        for _ in range(3):
            page.click("#undo")
        page.wait_for_selector("#undo[disabled]")
        assert end_of(page) == pytest.approx(start, abs=1e-3)


def drag(page, selector, dx, dy):
    x, y = centre(page, selector)
    page.mouse.move(x, y)
    page.mouse.down()
    for k in range(1, 9):
        page.mouse.move(x + dx * k / 8, y + dy * k / 8)
        page.wait_for_timeout(60)
    page.wait_for_timeout(500)
    page.mouse.up()
    page.wait_for_timeout(200)


def end_of(page):
    """Where the selected element's first end is, as its handle says."""
    label = page.locator(".handle >> nth=0").get_attribute("aria-label")
    return [float(number) for number in re.search(r": (-?[\d.]+), (-?[\d.]+)$", label).groups()]


def test_a_scene_is_built_saved_and_loaded_and_says_what_games_need(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "stage")
        page.select_option("#palette select", "any scene:bumper")
        page.click("#palette button")
        page.wait_for_selector("#elements option:nth-child(14)", state="attached")
        assert page.locator("#notice").inner_text().startswith("max_speed = ")
        page.fill("#fields label:has-text('radius') input", "0.1")
        page.keyboard.press("Tab")
        page.fill("#name", "mine")
        page.click("#save")
        page.wait_for_selector("code:has-text('mine.toml')")
        assert page.locator("#line").inner_text() == f"World(load_scene({str(lab.folder / 'mine.toml')!r}))"
        saved = load_scene(lab.folder / "mine.toml")
        assert len(saved.elements) == 14
        assert saved.elements[13].radius == 0.1
        page.click("#save")
        page.wait_for_selector("#notice.error:has-text('mine.toml is there already')")
        for k, option in enumerate(page.locator("#palette option").all()):
            page.select_option("#palette select", option.get_attribute("value"))
            page.click("#palette button")
            page.wait_for_selector(f"#elements option:nth-child({15 + k})", state="attached")
        page.select_option("#scenes", "builtin:pinball")
        page.click("#load")
        page.wait_for_selector("#needs li:has-text('Bounce/Pinball-v0: complete')")
        page.focus("#canvas")
        page.keyboard.press(" ")
        page.wait_for_timeout(500)
        page.keyboard.press(" ")
        page.keyboard.down("ArrowLeft")
        page.keyboard.up("ArrowLeft")
        page.keyboard.press(".")
        page.wait_for_selector("#status:has-text('bounces 1')")


def test_the_ghost_leaves_the_ball_and_says_why_it_cannot_run(browser, lab):
    with page_of(browser) as page:
        opened(page, lab, "stage")
        page.click("#ghost")
        page.wait_for_selector("#status:has-text('stepper is 0.000 m off')")
        page.click("#play")
        page.wait_for_timeout(1500)
        page.click("#play")
        off = re.search(r"stepper is ([\d.e-]+) m off", page.locator("#status").inner_text())[1]
        assert float(off) > 1e-4
        assert page.locator("#chart canvas").count() == 1
        page.fill("#world label:has-text('ball.radius') input", "0.02")
        page.keyboard.press("Tab")
        page.wait_for_selector("#status:has-text('No ghost: ball: radius=0.02')")


def test_a_ball_is_launched_by_dragging_from_it_with_a_finger(browser, lab):
    with page_of(browser, has_touch=True) as page:
        opened(page, lab, "stage")
        before = page.locator("#status").inner_text()
        board = page.locator("#canvas").bounding_box()
        scene = load_scene("tutorial")
        left, bottom, right, _ = scene.bounds
        margin = 0.05 * (right - left)
        scale = board["width"] / (right - left + 2 * margin)
        x = board["x"] + (0.8208 - left + margin) * scale
        y = board["y"] + board["height"] - (0.954545 - bottom + margin) * scale
        client = page.context.new_cdp_session(page)
        for kind, points in (
            ("touchStart", [{"x": x, "y": y}]),
            ("touchMove", [{"x": x - 60, "y": y + 20}]),
            ("touchEnd", []),
        ):
            client.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        until(page, lambda: page.locator("#status").inner_text() != before)
        assert "speed 0.0000" not in page.locator("#status").inner_text()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("room", ROOMS)
def test_everyone_can_use_it_and_nothing_is_cut_off(browser, lab, room, scheme):
    for size in (WIDE, NARROW):
        with page_of(browser, viewport=size, color_scheme=scheme, reduced_motion="reduce") as page:
            opened(page, lab, room)
            page.wait_for_timeout(300)
            check_that_everyone_can_use(page)


def test_one_tab_too_many_is_told_so(browser, lab):
    pages = []
    context = browser.new_context()
    for k in range(9):
        page = context.new_page()
        page.goto(lab.address("reflection") if k == 0 else lab.address("reflection").partition("?")[0])
        pages.append(page)
        if k < 8:
            page.wait_for_selector("#numbers tr")
    pages[8].wait_for_selector("#notice:has-text('8 tabs are open')")
    context.close()
