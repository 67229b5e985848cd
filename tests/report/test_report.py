"""`python -m bounce_env report --quick`, run once: what it writes, and what is in it."""

import json
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from bounce_env.commands import main
from bounce_env.report.model import ErrorRow, Spread, read_report, write_report
from bounce_env.report.problems import PROBLEMS
from bounce_env.report.run import Options, Store, planned
from tests.conftest import SOAK

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
WATCHDOG = 600.0  # ten times what it takes with kernels on disk; they may have to be compiled


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The report, made by the command in a process of its own."""
    output = tmp_path_factory.mktemp("report")
    words = [sys.executable, "-m", "bounce_env", "report", *([] if SOAK else ["--quick"]), "-o", str(output)]
    timeout = None if SOAK else WATCHDOG
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False, timeout=timeout)
    assert done.returncode == 0, done.stderr
    assert "report.html: " in done.stdout
    return output


def test_every_scene_and_method_has_a_row_or_a_reason(folder: Path):
    report = read_report(folder / "report.json")
    methods = set(report.header["methods"])
    assert methods >= {
        "engine",
        "engine_frames",
        "engine_batch",
        "tutorial_recheck",
        "moreau",
        "pymunk",
        "box2d",
        "scipy",
    }
    for which in PROBLEMS:
        rows = [row for row in report.errors if row.problem == which.name]
        assert {row.method for row in rows} == methods
        for row in rows:
            assert bool(row.reason) == (row.error is None)
            assert not row.reason.startswith("failed"), row
    assert not [row for row in report.long if row.reason.startswith("failed")]


def test_this_engine_is_exact_on_all_problems(folder: Path):
    ours = [row for row in read_report(folder / "report.json").errors if row.method.startswith("engine")]
    assert len(ours) == 3 * len(PROBLEMS)
    for row in ours:
        assert row.error.high < 1e-11, row
        assert row.wrong_order in (None, 0.0), row
        assert not row.missed, row
        assert row.lost == 0.0, row


def test_long_runs_keep_energy(folder: Path):
    rows = [
        row for row in read_report(folder / "report.json").long if row.method == "engine" and row.energy is not None
    ]
    assert len(rows) == 3
    for row in rows:
        assert row.bounces > (900_000 if SOAK else 15_000)
        assert row.energy < 1e-10


def test_no_hard_case_is_wrong(folder: Path):
    rows = read_report(folder / "report.json").stability
    assert len(rows) >= (120 if SOAK else 80)
    tried = Counter(row.mechanism for row in rows)
    assert len(tried) >= 30
    assert min(tried.values()) >= 2
    assert {row.kind for row in rows} == {"stiff", "extreme", "degenerate"}
    for row in rows:
        assert row.verdict == "right", row
        assert row.why
        assert row.source
        assert all(row.__dict__[peer] for peer in ("pymunk", "box2d", "tutorial"))


def test_the_page_stands_alone_and_describes_its_pictures(folder: Path):
    page = (folder / "report.html").read_text()
    assert len(page) < 10_000_000
    assert not re.search(r'(?:src|href)="(?!data:|#)', page)
    images = re.findall(r"<img [^>]*>", page)
    assert len(images) == len(PROBLEMS) + 2
    for image in images:
        assert len(re.search(r'alt="([^"]*)"', image).group(1)) > 40
    for which in PROBLEMS:
        assert f'id="error-{which.name}"' in page
        assert (folder / f"error_{which.name}.png").read_bytes().startswith(b"\x89PNG")
    for part in ("errors", "long", "stability", "features", "speed"):
        assert len((folder / f"{part}.csv").read_text().splitlines()) >= 2
    assert not list(folder.glob(".*"))  # nothing unfinished is left


def test_header_says_where_and_how(folder: Path):
    header = json.loads((folder / "report.json").read_text())["header"]
    for name in ("made", "bounce_env", "commit", "processor", "cores", "load", "seed", "python", "methods"):
        assert name in header
    page = (folder / "report.html").read_text()
    assert header["processor"] in page
    assert header["made"] in page


def test_it_is_read_as_it_was_written(folder: Path, tmp_path: Path):
    report = read_report(folder / "report.json")
    write_report(report, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_text() == (folder / "report.json").read_text()


@pytest.fixture
def again(folder: Path, tmp_path: Path):
    """A second run of a part of it, by this process."""
    words = ["report", "error", "--quick", "--only", "zeno_drop,circle,engine,pymunk,tutorial_recheck"]
    assert main([*words, "-o", str(tmp_path / "again"), "--compare", str(folder / "report.json")]) == 0
    return read_report(tmp_path / "again" / "report.json")


@pytest.mark.skipif(SOAK, reason="the first run was not quick")
def test_a_second_run_has_the_same_errors_to_the_bit(folder: Path, again):
    first = {(r.problem, r.method, r.setting): r for r in read_report(folder / "report.json").errors}
    assert len(again.errors) == 9
    for row in again.errors:
        old = first[row.problem, row.method, row.setting]
        assert replace(row, cost=None) == replace(old, cost=None)


def test_compare_finds_what_has_become_worse(folder: Path, tmp_path: Path, capsys):
    older = read_report(folder / "report.json")
    perfect = Spread(1e-19, 1e-19, 1e-19)
    older.errors = [
        replace(row, error=perfect) if row.method == "engine" and row.problem == "gravity_box" else row
        for row in older.errors
    ]
    write_report(older, tmp_path / "older.json")
    words = ["report", "error", "--quick", "--only", "gravity_box,engine", "-o", str(tmp_path / "now")]
    assert main([*words, "--compare", str(tmp_path / "older.json")]) == 1
    assert "worse: gravity_box engine exact" in capsys.readouterr().out


def test_a_run_that_was_interrupted_goes_on(tmp_path: Path, monkeypatch, capsys):
    words = ["report", "error", "--quick", "--only", "zeno_drop,tutorial_recheck,moreau", "-o", str(tmp_path)]
    (tmp_path / "report.json").write_text("an older report")
    real_keep, kept = Store.keep, []

    def keep_one(store: Store, name: str, row: ErrorRow) -> None:
        if kept:
            raise KeyboardInterrupt
        kept.append(name)
        real_keep(store, name, row)

    monkeypatch.setattr(Store, "keep", keep_one)
    assert main(words) == 130
    assert (tmp_path / "report.json").read_text() == "an older report"
    monkeypatch.setattr(Store, "keep", real_keep)
    capsys.readouterr()
    assert main([*words, "--resume"]) == 0
    assert "1 row of an interrupted run" in capsys.readouterr().out
    assert len(read_report(tmp_path / "report.json").errors) == 4


def test_another_run_takes_nothing_over(tmp_path: Path):
    path = tmp_path / "rows"
    store = Store(path, Options(quick=True), resume=False)
    for name in "abc":
        store.keep(name, ErrorRow("box", "engine", name))
    lines = path.read_text().splitlines()
    damaged = [
        *lines[:2],
        "5",
        '["d", "nope", {}]',
        '["e", "errors", 5]',
        '["f", "errors", {}]',
        *lines[3:],
        '["g", "err',
    ]
    path.write_text("\n".join(damaged))
    assert Store(path, Options(quick=True), resume=True).rows.keys() == {"a", "c"}
    assert not Store(path, Options(quick=False), resume=True).rows


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--only", "boxx"], "--only boxx: unknown scene or method (did you mean 'box'?)"),
        (["stability", "--only", "box"], "--only box: nothing of the part 'stability' is about it"),
        (["--seed", "-1"], "--seed -1: must be >= 0"),
        (["--compare", "absent.json"], "--compare absent.json: cannot be read as a report"),
        (["-o", "/dev/null/report"], "--output /dev/null/report: cannot be written"),
    ],
)
def test_bad_usage_is_refused(words: list[str], message: str, capsys):
    assert main(["report", *words]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"schema": 99}', "schema = 99: must be 1"),
        ("[" * 100_000, "cannot be read as a report"),
        ('{"schema": 1, "errors": [{"problem": "box", "colour": "red"}]}', "errors: unknown fields ['colour']"),
        ('{"schema": 1, "errors": [{"problem": "box", "method": "a", "setting": "b", "error": 1.0}]}', "error = 1.0: "),
        ('{"schema": 1, "errors": [{"problem": "box"}]}', "errors: method = "),
        ('{"schema": 1, "errors": [5]}', "must be a row of one of errors, "),
        ('{"schema": 1, "header": {"quick": true, "seed": 0}}', "quick = True: must be False as in this run"),
    ],
)
def test_a_file_that_is_no_report_is_refused(text: str, message: str, tmp_path: Path, capsys):
    (tmp_path / "old.json").write_text(text)
    assert main(["report", "--compare", str(tmp_path / "old.json")]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "old.json" in error


def test_a_comparison_with_nothing_is_a_problem(tmp_path: Path, capsys):
    (tmp_path / "old.json").write_text('{"schema": 1, "header": {"quick": true, "seed": 0}}')
    words = ["report", "error", "--quick", "--only", "zeno_drop,tutorial_recheck", "-o", str(tmp_path / "now")]
    assert main([*words, "--compare", str(tmp_path / "old.json")]) == 1
    assert "nothing to compare" in capsys.readouterr().out


def test_what_is_left_of_an_older_report_goes(tmp_path: Path):
    for name in ("speed.png", "speed.csv", "error_box.png", "my.png"):
        (tmp_path / name).write_text("old")
    assert main(["report", "error", "--quick", "--only", "zeno_drop,tutorial_recheck", "-o", str(tmp_path)]) == 0
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"error_zeno_drop.png", "errors.csv", "my.png", "report.html", "report.json"}


def test_the_full_report_has_the_scenes_methods_and_settings_that_it_promises():
    jobs, _ = planned(Options())
    names = [job.name for job in jobs]
    assert len(names) == len(set(names))
    assert "error pinball pymunk 1/15360 s" in names
    assert "error circle box2d 1/60 s" in names
    assert "speed Bounce/Pinball-v0, vector env 65536" in names
    assert "features walls" in names
    assert sum(name.startswith("stability ") for name in names) >= 120
