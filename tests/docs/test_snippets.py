"""Every snippet of README and site is run, from the page itself; every line for a shell can be typed as it stands."""

import os
import re
import runpy
import shlex
import subprocess
import sys
import tomllib

import pytest
import tyro
import yaml

from bounce_env import load_scene
from bounce_env.commands.options import read
from tests.docs.pages import PAGES, ROOT, commands, name_of, snippets

LANGUAGES = {"python", "toml", "text", "", "{toctree}", "{include}", "{image}"}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]

WITH_CODE = [page for page in PAGES if any(snippet.language == "python" for snippet in snippets(page))]
WITH_COMMANDS = [page for page in PAGES if commands(page)]


@pytest.mark.parametrize("page", WITH_CODE, ids=name_of)
def test_code_of_a_page_runs(page, tmp_path):
    """In one namespace from the first block to the last; a block of TOML before it is the file my.toml."""
    script = []
    for snippet in snippets(page):
        if snippet.language == "toml":
            (tmp_path / "my.toml").write_text(snippet.code)
        elif snippet.language == "python":
            script.append("\n" * max(0, snippet.line - 1 - sum(part.count("\n") for part in script)) + snippet.code)
    (tmp_path / "page.py").write_text("".join(script))
    command = [sys.executable, "-W", "error", "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r}); {RUN}"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]


RUN = 'exec(compile(open("page.py").read(), "page.py", "exec"))'


def test_pages_have_code_at_all():
    assert {"README.md", "docs/quickstart.md", "docs/scenes.md", "docs/training.md", "docs/tutorial.md"} <= {
        name_of(page) for page in WITH_CODE
    }


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_blocks_say_what_they_are(page):
    for snippet in snippets(page):
        known = snippet.language in LANGUAGES or snippet.language.startswith("{literalinclude}")
        assert known, f"{page}:{snippet.line}: {snippet.language}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_scenes_of_a_page_are_scenes(page, tmp_path):
    for snippet in snippets(page):
        if snippet.language == "toml":
            (tmp_path / "scene.toml").write_text(snippet.code)
            assert load_scene(tmp_path / "scene.toml").elements


@pytest.mark.parametrize("page", WITH_COMMANDS, ids=name_of)
def test_commands_of_a_page_can_be_typed(page, monkeypatch):
    for line in commands(page):
        check_command(line, monkeypatch)


def check_command(line, monkeypatch):
    """Fail where a line for a shell names what there is not: a command, an option, a target, a file, an extra."""
    words = [word for word in shlex.split(line, comments=True) if not re.match(r"[A-Z_]+=", word)]
    program, rest = words[0].removeprefix(".venv/bin/"), words[1:]
    if program == "python" and rest[:1] == ["-m"]:
        program, rest = rest[1], rest[2:]
    match program:
        case "bounce-env" | "bounce_env":
            check_own(rest)
        case "make":
            targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
            assert not set(rest) - set(targets), line
        case "pytest":
            for word in rest:
                assert word.startswith("-") or (ROOT / word).exists() or rest[rest.index(word) - 1] == "-m", line
        case "pip":
            for extra in re.findall(r"\[(\w+)\]", line):
                assert extra in PROJECT["optional-dependencies"], line
        case _ if program.startswith("agents."):
            check_agents(program, rest, monkeypatch)
        case _ if program.startswith("tests."):
            assert (ROOT / f"{program.replace('.', '/')}.py").is_file(), line
        case "rl_zoo3.train":
            env, file = (rest[rest.index(option) + 1] for option in ("--env", "--conf-file"))
            assert env in yaml.safe_load((ROOT / file).read_text()), line
        case _:
            assert program in ("git", "pre-commit", "twine", "python"), line


ENDING = re.compile(
    r"^(bounce-env (scenes list|scenes draw my|doctor|watch pinball --film)|.*agents.evaluate random --env-id)"
)
"""Commands that end by themselves within a minute; the others open a window, serve pages, or take long."""


def test_commands_that_end_are_run(tmp_path):
    scene = next(s.code for s in snippets(ROOT / "docs" / "scenes.md") if s.language == "toml")
    (tmp_path / "my.toml").write_text(scene)
    lines = {line for page in PAGES for line in commands(page) if ENDING.match(line)}
    assert len(lines) >= 5
    environment = {**os.environ, "SDL_VIDEODRIVER": "dummy", "PYTHONPATH": str(ROOT)}
    for line in sorted(lines):
        words = shlex.split(line, comments=True)
        own = words[0] == "bounce-env"
        command = [sys.executable, "-m", "bounce_env", *words[1:]] if own else [sys.executable, *words[1:]]
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=600, check=False
        )
        assert done.returncode == 0, f"{line}\n{done.stdout[-1500:]}{done.stderr[-1500:]}"
    assert (tmp_path / "my.png").stat().st_size > 1000
    assert (tmp_path / "game.mp4").stat().st_size > 10_000


def check_own(words):
    """Read the words as the command line does."""
    if words in ([], ["--version"], ["doctor"]):
        return
    if len(words) == 1 and words[0] in ("scenes", "play", "compile", "replay", "watch"):
        return  # a command's name alone, in a sentence
    assert hasattr(read([word.replace("...", "x") for word in words]), "run")


def check_agents(module, words, monkeypatch):
    """Read the words as a script of `agents` does, and do nothing."""
    monkeypatch.setattr("agents.command.run", lambda command, options: tyro.cli(options))
    monkeypatch.setattr(sys, "argv", [module, *words])
    monkeypatch.delitem(sys.modules, module, raising=False)
    try:
        runpy.run_module(module, run_name="__main__")
    except SystemExit as left:
        if left.code and words:  # without words it is a script's name alone, in a sentence
            raise


def test_a_command_that_is_wrong_is_noticed(monkeypatch):
    wrong = (
        "make tset",
        "bounce-env scenes chekc x.toml",
        "pytest tests/nowhere.py",
        'python -m pip install ".[clii]"',
        "python -m agents.evaluate random --episods 3",
        "python -m agents.nothing",
    )
    for line in wrong:
        with pytest.raises((AssertionError, SystemExit, ImportError)):
            check_command(line, monkeypatch)
