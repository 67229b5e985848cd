"""`report`."""

from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from tqdm import tqdm

from bounce_env.commands.cli import FINE, PROBLEMS, Refused, check_range, say
from bounce_env.report.methods import all_methods
from bounce_env.report.model import ErrorRow, Report, read_report
from bounce_env.report.output import write_all
from bounce_env.report.problems import PROBLEMS as PROBLEMS_OF_REPORT
from bounce_env.report.run import PARTS, Job, Options, Store, header_of, planned, run
from bounce_env.report.winners import pairs_compared, wins_of_peers, worse_errors
from bounce_env.scene import builtin_scenes
from bounce_env.wording import counted, unknown_name


def make_report(
    part: str, *, output: Path, quick: bool, only: str, resume: bool, compare: Path | None, seed: int
) -> int:
    """Measure, write and compare; returns PROBLEMS where an error has become worse than in `compare`."""
    check_range("seed", seed, 0)
    scenes, methods = _only(only)
    parts = PARTS if part == "all" else (part,)
    options = Options(parts=parts, quick=quick, seed=seed, scenes=scenes, methods=methods)
    older = None if compare is None else _older(compare, options)
    jobs, used = planned(options)
    if not jobs:
        raise Refused(f"--only {only}: nothing of the part {part!r} is about it")
    try:
        output.mkdir(parents=True, exist_ok=True)
        store = Store(output / ".unfinished.jsonl", options, resume=resume)
    except OSError as error:
        raise Refused(f"--output {output}: cannot be written: {error}") from error
    if store.interrupted:
        what = "are taken over" if resume else "are measured again; --resume would take them over"
        say(f"{counted(store.interrupted, 'row')} of an interrupted run {what}")
    report = run(jobs, header_of(options, used), store, _progress)
    write_all(report, output)
    store.remove()
    _summarize(report, output)
    return FINE if older is None else _compared(report, older)


def _only(only: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the scenes and the methods that are named, in any order."""
    scenes, methods = [], []
    known_scenes = {*builtin_scenes(), *(p.name for p in PROBLEMS_OF_REPORT)}
    known_methods = {method.name for method in all_methods()}
    for name in filter(None, only.split(",")):
        if name in known_scenes:
            scenes.append(name)
        elif name in known_methods:
            methods.append(name)
        else:
            raise Refused(
                f"--only {only}: {unknown_name(name, sorted(known_scenes | known_methods), 'scene or method')}"
            )
    return tuple(scenes), tuple(methods)


def _older(compare: Path, options: Options) -> Report:
    try:
        older = read_report(compare)
    except ValueError as error:
        raise Refused(f"--compare {error}") from error
    for name, value in (("quick", options.quick), ("seed", options.seed)):
        if older.header.get(name) != value:
            raise Refused(f"--compare {compare}: {name} = {older.header.get(name)!r}: must be {value!r} as in this run")
    return older


def _progress(jobs: Collection[Job]) -> Iterable[Job]:
    """Yield the jobs, and show which is under way; where nobody sees a bar move, a line for each tenth."""
    with tqdm(total=len(jobs), unit=" rows", disable=None, leave=False) as bar:
        yield from _shown(jobs, bar)


def _shown(jobs: Collection[Job], bar: tqdm) -> Iterator[Job]:
    for done, job in enumerate(jobs):
        bar.set_postfix_str(job.name)
        if bar.disable and done % max(1, len(jobs) // 10) == 0:
            say(f"{done} of {len(jobs)} rows: {job.name} ...")
        yield job
        bar.update()


def _summarize(report: Report, output: Path) -> None:
    say(f"{output / 'report.html'}: {', '.join(f'{len(rows)} {part}' for part, rows in report.rows.items())}")
    wins = wins_of_peers(report.errors)
    for win in wins:
        peer = f"{win.peer.method} at {win.peer.setting}"
        say(f"  {win.problem}: {peer} is faster and more accurate than {win.ours.method}")
    if pairs_compared(report.errors) and not wins:
        say("  no other method is both faster and more accurate, beyond the spread, on any problem")


def _compared(report: Report, older: Report) -> int:
    compared, worse = worse_errors(report.errors, older.errors)
    for row, old in worse:
        say(f"  worse: {row.problem} {row.method} {row.setting}: {_in_words(row)}; was {_in_words(old)}")
    if not compared:
        say("  nothing to compare: the older report has no row of this engine that this one has")
        return PROBLEMS
    if not worse:
        say(f"  none of {counted(compared, 'row')} of this engine is worse than before")
    return PROBLEMS if worse else FINE


def _in_words(row: ErrorRow) -> str:
    if row.error is None:
        return row.reason
    return f"error {row.error.median:.2g} m, wrong order {row.wrong_order}, lost {row.lost}"
