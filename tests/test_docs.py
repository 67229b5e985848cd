"""What the documents say is so: the table of info keys, the version, and the files that they name."""

import ast
import io
import re
import tokenize
import tomllib
from pathlib import Path
from tokenize import COMMENT

import gymnasium as gym
import pytest
import yaml

import bounce_env
from bounce_env.envs.paddle import PaddleEnv
from bounce_env.envs.pinball import PinballEnv
from bounce_env.envs.walls import WallsEnv
from bounce_env.extras import version
from tests.docs.pages import PAGES, name_of

ROOT = Path(bounce_env.__file__).parent.parent
PADDLE, PINBALL, WALLS = "Bounce/Paddle-v0", "Bounce/Pinball-v0", "Bounce/Walls-v0"
CARDS = {PADDLE: PaddleEnv, PINBALL: PinballEnv, WALLS: WallsEnv}


def info_table():
    """By key: when, games, type."""
    rows = re.findall(r"^\| `(\w+)` \| ([^|]+) \| ([^|]+) \| ([^|]+) \|", (ROOT / "docs/info.md").read_text(), re.M)
    return {key: (when, games, kind) for key, when, games, kind in rows}


def names(games: str, env_id: str, levels: bool) -> bool:
    """Whether a cell of the table is about a game."""
    short = env_id.removeprefix("Bounce/").removesuffix("-v0")
    if "num_levels" in games:
        return levels and short in games
    return games == "all" or short in games.split(", ")


@pytest.mark.parametrize(("env_id", "kwargs"), [(PADDLE, {}), (PADDLE, {"num_levels": 3}), (PINBALL, {}), (WALLS, {})])
def test_info_holds_what_the_table_says_no_more_and_no_less(env_id, kwargs):
    table = info_table()
    mine = {key: (when, kind) for key, (when, games, kind) in table.items() if names(games, env_id, bool(kwargs))}
    each = {key for key, (when, _) in mine.items() if when == "each step"}
    env = gym.make(env_id, time_limit=4.0, **kwargs)
    _, info = env.reset(seed=0)
    assert set(info) == each
    over = False
    while not over:
        *_, terminated, truncated, info = env.step(env.action_space.sample() * 0)
        over = terminated or truncated
        assert set(info) == (set(mine) if over else each)
    kinds = {"float": float, "int": int, "str": str, "bool": bool}
    for key, (_, kind) in mine.items():
        assert type(info[key]) is kinds[kind]
        assert f"`{key}`" in CARDS[env_id].__doc__


def test_versions_agree():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert project["version"] == citation["version"] == version() == bounce_env.__version__


def test_quickstart_has_every_extra_that_users_need():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    quickstart = (ROOT / "docs/quickstart.md").read_text()
    for extra in project["optional-dependencies"]:
        if extra != "dist":
            assert f"| `{extra}` |" in quickstart


DOCUMENTS = [name_of(page) for page in PAGES]
SOURCES = sorted(path for folder in ("bounce_env", "agents", "tests", ".ci") for path in (ROOT / folder).rglob("*.py"))
FILE = re.compile(r"[\w][\w./-]*\.(?:md|toml|py|txt|json|yml|cff|png|gif)\b")


def texts_of(path: Path) -> tuple[list[str], list[str]]:
    """The docstrings and comments of a module, and its other strings."""
    source = path.read_text()
    told = [token.string for token in tokenize.generate_tokens(io.StringIO(source).readline) if token.type == COMMENT]
    strings = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            told.append(node.value.value)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            strings.append(node.value)
    return told, [text for text in strings if text not in told]


def is_there(name: str, path: Path) -> bool:
    """Whether a cited file is in the repository, seen from its root, the package, the engine, or the module."""
    places = (ROOT, ROOT / "bounce_env", ROOT / "bounce_env" / "engine", path.parent)
    return any((place / name).is_file() for place in places)


def test_docstrings_and_comments_cite_files_that_are_there():
    """Or that the code of the same folder reads or writes itself; NAME is a placeholder."""
    texts = {path: texts_of(path) for path in SOURCES}
    folder_of = {path: path.relative_to(ROOT).parts[0] for path in SOURCES}
    own: dict[str, list[str]] = {}
    for path, (_, strings) in texts.items():
        own.setdefault(folder_of[path], []).extend(strings)
    missing, found = [], 0
    for path, (told, _) in texts.items():
        for name in {name for text in told for name in FILE.findall(text)}:
            written = (name in text or text == Path(name).stem for text in own[folder_of[path]])
            if "NAME" in name or ("/" not in name and any(written)):
                continue
            found += 1
            if not is_there(name, path):
                missing.append(f"{path.relative_to(ROOT)}: {name}")
    assert missing == []
    assert found > 5


def test_a_file_that_is_not_there_is_noticed(tmp_path):
    module = tmp_path / "module.py"
    module.write_text('"""As in docs/nowhere.md."""\nX = 1  # lost.py\nPATH = "own.json"  # own.json is written\n')
    told, strings = texts_of(module)
    assert {name for text in told for name in FILE.findall(text)} == {"docs/nowhere.md", "lost.py", "own.json"}
    assert "own.json" in strings
    assert not is_there("docs/nowhere.md", module)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_files_that_are_linked_or_named_are_there(document):
    text = (ROOT / document).read_text()
    named = re.findall(r"\]\(((?!http)[^)#]+)\)", text) + re.findall(
        r"`((?:tests|docs|configs|bounce_env|\.github)/[\w./-]+\.\w+)`", text
    )
    assert document != "README.md" or len(named) > 3
    for path in map(source_of, named):
        assert "NAME" in path or (ROOT / path).exists() or ((ROOT / document).parent / path).exists(), path


def source_of(path: str) -> str:
    """Return what a page of the gallery is made of; any other path as it is."""
    made = re.fullmatch(r"gallery/(\w+)\.rst", path)
    if made is None:
        return path
    return "examples/README.rst" if made[1] == "index" else f"examples/{made[1]}.py"


def test_a_link_to_an_example_that_is_not_there_is_noticed():
    assert (ROOT / "docs" / source_of("gallery/plot_10_trajectory.rst")).exists()
    assert not (ROOT / "docs" / source_of("gallery/plot_99_nothing.rst")).exists()


@pytest.mark.parametrize("workflow", sorted((ROOT / ".github" / "workflows").glob("*.yml")), ids=lambda path: path.name)
def test_workflows_are_yaml_with_all_pythons_and_systems(workflow):
    jobs = yaml.safe_load(workflow.read_text())["jobs"]
    for job in jobs.values():
        assert job["strategy"]["matrix"]["python"] == ["3.11", "3.12", "3.13", "3.14"]
        assert len(job["strategy"]["matrix"]["os"]) == 3
