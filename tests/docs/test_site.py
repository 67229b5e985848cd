"""The site: it builds without a warning, its examples run, it loads nothing from elsewhere, and all is in it."""

import os
import re
import shutil
import subprocess
import sys
import zlib
from html.parser import HTMLParser
from typing import get_args
from urllib.parse import unquote, urlsplit

import gymnasium as gym
import pytest
from playwright.sync_api import sync_playwright

from bounce_env.envs import vector_env_of
from bounce_env.lab.benchmark import browser_path
from bounce_env.registration import ENTRIES
from bounce_env.report.stability.mechanisms import MECHANISMS, tried_cases
from bounce_env.scene import Element, load_scene
from tests.conftest import require
from tests.docs.pages import DOCS
from tests.vendored import check_vendored

sys.path.insert(0, str(DOCS))
from generate import docstrings, public, scene_reference

LOADS = {
    **dict.fromkeys(("script", "img", "iframe", "video", "audio", "source", "embed"), "src"),
    "object": "data",
    "link": "href",
}
"""The attributes for which a browser fetches something."""

REPLAYS = ("replay", "gallery/plot_04_video_and_replay")
"""Pages on which a replay shows itself."""

INKED = """canvas => {
    const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let inked = 0;
    for (let i = 0; i < data.length; i += 4) inked += data[i] + data[i + 1] + data[i + 2] > 240;
    return inked;
}"""
"""How many pixels of a canvas are bright."""

NAVIGATES = {"next", "prev", "index", "search", "up", "canonical"}
"""Kinds of <link> for which it does not."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, built as `make docs` does, from nothing: each example runs."""
    for folder in ("gallery", "_made"):
        shutil.rmtree(DOCS / folder, ignore_errors=True)
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-E", "-b", "html", str(DOCS), str(out / "html")]
    environment = {**os.environ, "SDL_VIDEODRIVER": "dummy", "MPLBACKEND": "agg"}
    done = subprocess.run(
        [*command, "-d", str(out / "doctrees")],
        env=environment,
        capture_output=True,
        text=True,
        timeout=1200,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-6000:]
    return out / "html"


class Tags(HTMLParser):
    """What a page has: its tags with their attributes, and the anchors that can be jumped to."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        told = dict(attributes)
        self.tags.append((tag, told))
        self.anchors |= {told[name] for name in ("id", "name") if told.get(name)}


def pages_of(site):
    return {page: Tags(page.read_text(encoding="utf-8")) for page in sorted(site.rglob("*.html"))}


def is_elsewhere(address):
    return bool(re.match(r"(?:\w+:)?//", address))


def test_every_example_ran(site):
    examples = sorted(path.stem for path in (DOCS / "examples").glob("plot_*.py"))
    assert len(examples) >= 10
    for name in examples:
        page = (site / "gallery" / f"{name}.html").read_text()
        assert "sphx-glr-script-out" in page or "sphx-glr-single-img" in page, name


def test_nothing_is_loaded_from_elsewhere(site):
    loaded = []
    for page, tags in pages_of(site).items():
        for tag, told in tags.tags:
            address = told.get(LOADS.get(tag, ""), "") or ""
            navigates = tag == "link" and NAVIGATES.intersection((told.get("rel") or "").split())
            if is_elsewhere(address) and not navigates:
                loaded.append(f"{page.name}: {address}")
    for style in site.rglob("*.css"):
        text = style.read_text(encoding="utf-8")
        loaded += [
            f"{style.name}: {a}" for a in re.findall(r"(?:url\(|@import)\s*[\"']?([^\"')\s]+)", text) if is_elsewhere(a)
        ]
    assert loaded == []


def test_a_browser_asks_for_nothing_but_files_of_the_site(site):
    path = browser_path()
    require("browser", path is not None, "Chromium or Chrome on the path")
    asked, complaints = [], []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        page = browser.new_page()
        page.on("request", lambda request: asked.append(request.url))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("requestfailed", lambda request: complaints.append(f"{request.url}: {request.failure}"))
        for name in ("index", "physics", "tutorial", "scenes", "environments/pinball", "api/engine", *REPLAYS):
            page.goto((site / f"{name}.html").as_uri())
            page.wait_for_load_state("networkidle")
            if name in REPLAYS:
                drawn = page.frame_locator("iframe").locator("canvas").first
                assert drawn.evaluate(INKED) > 1000, name
        page.goto((site / "tutorial.html").as_uri())
        page.wait_for_selector("mjx-container svg")  # formulas are drawn, by what is shipped
        formulas = page.locator("mjx-container").count()
        broken = page.evaluate("[...document.images].filter(image => !image.naturalWidth).length")
        browser.close()
    assert formulas > 10
    assert broken == 0
    assert complaints == []
    assert {urlsplit(url).scheme for url in asked} <= {"file", "data", "blob", "about"}


def test_every_link_inside_leads_somewhere(site):
    pages, lost = pages_of(site), []
    for page, tags in pages.items():
        for tag, told in tags.tags:
            href = told.get("href") or ""
            if (
                tag != "a"
                or not href
                or urlsplit(href).scheme
                or (href.startswith("#") and href[1:] in ("", "furo-main-content"))
            ):
                continue
            parts = urlsplit(href)
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            if not target.exists() or (
                parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors
            ):
                lost.append(f"{page.relative_to(site)}: {href}")
    assert lost == [], "\n".join(lost)


def test_every_public_name_is_on_the_api_pages(site):
    head, _, packed = (site / "objects.inv").read_bytes().partition(b"zlib.\n")
    assert b"bounce_env" in head
    described = {line.split()[0] for line in zlib.decompress(packed).decode().splitlines() if " py:" in line}
    names = {f"{name.module}.{name.path}" for name in public.public_names()}
    assert len(names) > 150
    assert names - described == set()


def test_every_docstring_of_a_public_name_says_what_it_must():
    """Parameters, errors, shapes, units and the source: docs/generate/docstrings.py says how each is looked for."""
    assert docstrings.missing_in_docstrings() == []


def documented(doc):
    """A function with a docstring, as a public name."""

    def shift(position: "npt.ArrayLike", by: float) -> None:  # noqa: F821
        pass

    shift.__doc__ = doc
    return public.Public("bounce_env", "shift", shift)


@pytest.mark.parametrize(
    ("doc", "missing"),
    [
        ("Move it by something, `position` too; (worlds, 2) [m]. Raises ValueError. docs/physics.md.", []),
        ("Move `position`, (worlds, 2) [m]. Raises ValueError. docs/physics.md.", ["parameter by"]),
        ("Move `position`, (worlds, 2) [m], by so much. docs/physics.md.", ["errors"]),
        ("Move `position` [m] by so much. Raises ValueError. docs/physics.md.", ["shape"]),
        ("Move `position`, (worlds, 2), by so much. Raises ValueError. docs/physics.md.", ["unit"]),
        ("Move `position`, (worlds, 2) [m], by so much. Raises ValueError.", ["source"]),
        ("Moves.", ["docstring"]),
    ],
)
def test_what_a_docstring_leaves_out_is_noticed(doc, missing):
    assert docstrings.lacks(documented(doc), {}) == missing


@pytest.mark.parametrize("env_id", [entry.id for entry in ENTRIES])
def test_pages_of_environments_have_every_number_of_an_observation(site, env_id):
    env = gym.make(env_id).unwrapped
    name = env_id.removeprefix("Bounce/").removesuffix("-v0").lower()
    text = (site / "environments" / f"{name}.html").read_text()
    table = text.partition("Observation, index by index<")[2]
    rows = re.findall(r"<tr[^>]*><td[^>]*><p>(\d+)</p></td>\s*<td[^>]*><p>(.*?)</p></td>", table, re.DOTALL)
    assert len(rows) >= len(env.observed) == env.observation_space.shape[0]
    for (index, what), (number, told) in zip(rows, enumerate(env.observed), strict=False):
        assert int(index) == number
        assert what.replace("’", "'") == told.what
    assert f"{name}-v0.gif" in text
    for keyword in vector_env_of(type(env)).defaults() | env.defaults():
        assert f">{keyword}<" in text


def test_every_element_and_field_is_in_the_reference():
    assert {spec for spec, _ in scene_reference.SPECS} == set(get_args(Element))
    for spec, examples in scene_reference.SPECS:
        told = scene_reference.meanings(spec)
        for field in spec.__dataclass_fields__:
            assert told.get(field), f"{spec.__name__}.{field}: its docstring does not tell what it is"
        for example in examples:
            shown = load_scene(scene_reference.EXAMPLES / f"{example.name}.toml")
            assert any(isinstance(element, spec) for element in shown.elements)


def test_the_page_of_stability_counts_all_cases(site):
    text = (site / "stability.html").read_text()
    cases = sum(sum(1 for _ in tried_cases(mechanism)) for mechanism in MECHANISMS)
    assert f"<strong>{cases} rows in {len(MECHANISMS)} mechanisms, none wrong</strong>" in text


def test_what_is_shipped_of_others_is_as_it_was():
    check_vendored(DOCS / "vendor")
