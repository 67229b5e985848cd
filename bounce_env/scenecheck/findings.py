"""What a survey has found, in words: problems of the scene, and notes on what is none."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Scene, Sensor
from bounce_env.scene.errors import describe_element
from bounce_env.scenecheck.crossings import crossings
from bounce_env.scenecheck.follow import CRUSHES, DRAINED, ENDLESS, LEFT, PLAYING, RATTLES, RESTS, STUCK
from bounce_env.scenecheck.places import Cluster, clusters
from bounce_env.scenecheck.reach import reach_boxes, scores
from bounce_env.scenecheck.run import Survey, place_size
from bounce_env.wording import counted

KINDS = ("problem", "warning", "note")


@dataclass(frozen=True)
class Finding:
    """A headline, and a line for each place, ball or element. kind: a scene fails by problems alone."""

    kind: Literal["problem", "warning", "note"]
    title: str
    lines: tuple[str, ...] = ()


def findings(survey: Survey) -> tuple[Finding, ...]:
    """All that a survey has found, problems first. Balls are given with the start that brings them there again.

    What is a problem because no agent can help is none in a scene that has no part for an agent to move.
    """
    found = [*_untouched(survey), *_lost(survey), *_broken(survey), *_crossings(survey.scene), *_notes(survey)]
    if reach_boxes(survey.scene):
        found += [*_traps(survey), *_endless(survey)]
    return tuple(sorted(found, key=lambda finding: KINDS.index(finding.kind)))


def _crossings(scene: Scene) -> Iterator[Finding]:
    found = crossings(scene)
    if found:
        lines = [
            f"{_name(scene, first)} and {_name(scene, second)}, at x {x:.4g}, y {y:.4g} m"
            for first, second, (x, y) in found
        ]
        yield Finding(
            "warning", f"standing elements run through each other: {counted(len(found), 'pair')}", tuple(lines)
        )


def _traps(survey: Survey) -> Iterator[Finding]:
    rests, away = survey.fates["end"] == RESTS, ~_within_reach(survey)
    yield from _by_place(survey, rests & away, "a ball comes to rest out of reach of every part that an agent moves")
    if _can_end(survey.scene):
        title = f"a ball goes on out of reach of every part that an agent moves for {survey.seconds / 2:g} s or more"
        yield from _by_place(survey, survey.fates["end"] == STUCK, title)


def _untouched(survey: Survey) -> Iterator[Finding]:
    goals = [index for index, element in enumerate(survey.scene.elements) if scores(element)]
    never = [_name(survey.scene, index) for index in goals if survey.touched[index] == 0]
    if never:
        yield Finding("problem", f"no ball of {counted(len(survey.fates), 'ball')} touches what scores", tuple(never))
    if not _can_end(survey.scene):
        return
    shut = [
        f"{_name(survey.scene, index)}: {counted(int(survey.touched[index]), 'ball')}"
        for index in goals
        if survey.touched[index] > 0 and survey.freely[index] == 0
    ]
    if shut:
        yield Finding("problem", "only balls that neither drain nor come within reach touch what scores", tuple(shut))


def _endless(survey: Survey) -> Iterator[Finding]:
    fates = survey.fates
    rows = np.flatnonzero(fates["run"] > survey.limit)
    rows = rows[np.argsort(-fates["run"][rows], kind="stable")]
    if len(rows):
        title = (
            f"a ball scores more than {survey.limit} times without coming within reach of a part that an agent moves"
        )
        lines = [f"{_how_often(survey, row)}, {_start(survey, row)}" for row in rows.tolist()]
        yield Finding("problem", f"{title}: {counted(len(rows), 'ball')}", tuple(lines))


def _how_often(survey: Survey, row: int) -> str:
    times = f"{survey.fates['run'][row]} times"
    return f"{times} and no end" if survey.fates["end"][row] == ENDLESS else times


def _lost(survey: Survey) -> Iterator[Finding]:
    """Return of a table with an inside: there all balls started."""
    rows = np.flatnonzero(survey.fates["end"] == LEFT).tolist()
    if survey.is_table and rows:
        title = f"a ball leaves the scene and crosses no drain: {counted(len(rows), 'ball')}"
        yield Finding("problem", title, tuple(_start(survey, row) for row in rows))


def _broken(survey: Survey) -> Iterator[Finding]:
    yield from _by_place(survey, survey.fates["end"] == CRUSHES, "a ball is crushed (status CRUSHED)")
    title = "a ball has so many events that games would end (status BUDGET)"
    yield from _by_place(survey, survey.fates["end"] == RATTLES, title)


def _notes(survey: Survey) -> Iterator[Finding]:
    ends, balls = survey.fates["end"], len(survey.fates)
    if not reach_boxes(survey.scene):
        yield Finding("note", "the scene has no part that an agent moves: nothing in it is within reach")
    if not survey.is_table:
        yield Finding("note", "walls and drains shut off no inside: balls start anywhere, and may leave the scene")
    for end, words in (
        (DRAINED, "drained"),
        (LEFT, "left the scene"),
        (PLAYING, f"still in play after {survey.seconds:g} s"),
    ):
        count = int(((ends == end) | ((ends == STUCK) & (end == PLAYING))).sum())
        if count:
            yield Finding("note", f"{words}: {counted(count, 'ball')} ({100 * count / balls:.4g} %)")
    where = " within reach of a part that an agent moves" if reach_boxes(survey.scene) else ""
    near = (ends == RESTS) & (_within_reach(survey) | (not where))
    for finding in _by_place(survey, near, f"a ball comes to rest{where}"):
        yield Finding("note", finding.title, finding.lines)


def _by_place(survey: Survey, which: npt.NDArray[np.bool_], title: str) -> Iterator[Finding]:
    rows = np.flatnonzero(which)
    if len(rows) == 0:
        return
    places = np.column_stack([survey.fates["x"][rows], survey.fates["y"][rows]])
    groups = clusters(places, 2.0 * place_size(survey.scene) or 1.0)
    lines = (
        f"{_where(group)}: {counted(len(group.rows), 'ball')}, {_start(survey, rows[group.rows[0]])}"
        for group in groups
    )
    yield Finding("problem", f"{title}: {counted(len(rows), 'ball')}", tuple(lines))


def _within_reach(survey: Survey) -> npt.NDArray[np.bool_]:
    """Return whether the balls ended within reach of a part that an agent moves."""
    x, y = survey.fates["x"], survey.fates["y"]
    within = np.zeros(len(x), np.bool_)
    for x_min, y_min, x_max, y_max in reach_boxes(survey.scene):
        within |= (x_min <= x) & (x <= x_max) & (y_min <= y) & (y <= y_max)
    return within


def _can_end(scene: Scene) -> bool:
    """Return whether a ball can drain or come within reach at all; in a closed box that is watched it cannot."""
    return bool(reach_boxes(scene)) or any(isinstance(e, Sensor) and e.drain for e in scene.elements)


def _where(group: Cluster) -> str:
    return f"at x {_range(group.x_min, group.x_max)}, y {_range(group.y_min, group.y_max)} m"


def _range(low: float, high: float) -> str:
    first, last = f"{low:.4g}", f"{high:.4g}"
    return first if first == last else f"{first} to {last}"


def _start(survey: Survey, row: int) -> str:
    """Return the start of a ball, with all digits: it takes the same way again."""
    x, y, vx, vy = survey.starts[row].tolist()
    return f"from position ({x!r}, {y!r}) velocity ({vx!r}, {vy!r})"


def _name(scene: Scene, index: int) -> str:
    return describe_element(scene.elements[index], index)
