"""`scenes check`."""

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial

from tqdm import tqdm

from bounce_env.commands.cli import FINE, PROBLEMS, Refused, check_range, say
from bounce_env.commands.scenes import check_named, outline
from bounce_env.scene import SceneError, load_scene
from bounce_env.scenecheck import Finding, NoRoomError, Survey, findings, survey
from bounce_env.wording import counted

MOST_BALLS = 100_000_000
MOST_SCORES = 1_000_000
LEAST_SECONDS, MOST_SECONDS = 10.0, 3600.0


def check_scenes(files: Sequence[str], *, balls: int, seed: int, seconds: float, scores: int, show: int) -> int:
    """Print what is wrong in each scene; returns PROBLEMS where anything is."""
    check_range("balls", balls, 1, MOST_BALLS)
    check_range("seed", seed, 0)
    check_range("seconds", seconds, LEAST_SECONDS, MOST_SECONDS)
    check_range("scores", scores, 1, MOST_SCORES)
    check_range("show", show, 0)
    if not files:
        raise Refused("files: must be at least one, path of a .toml file or name of a built-in scene")
    for source in files:
        check_named(source)
    # One after the other even where one is wrong: a user wants to read all that is.
    run = partial(survey, balls=balls, seed=seed, seconds=seconds, limit=scores)
    effort = f"{balls} balls of seed {seed}, up to {seconds:g} s each"
    wrong = [_is_wrong(source, run, balls, effort, show) for source in files]
    return PROBLEMS if any(wrong) else FINE


def _is_wrong(source: str, run: Callable[..., Survey], balls: int, effort: str, show: int) -> bool:
    try:
        scene = load_scene(source)
    except SceneError as error:
        say(str(error))
        return True
    say(f"{source}: {outline(scene)}; {effort}")
    try:
        # disable=None: no bar where nobody sees it move.
        with tqdm(total=balls, unit=" balls", disable=None, leave=False) as bar:
            found = findings(run(scene, progress=bar.update))
    except NoRoomError as error:
        say(f"  problem: {error}")
        return True
    for finding in found:
        for line in _printed(finding, show):
            say(f"  {line}")
    kinds = Counter(finding.kind for finding in found)
    counts = ", ".join(counted(kinds[kind], kind) for kind in ("problem", "warning") if kinds[kind])
    say(f"{source}: {counts or 'nothing wrong'}")
    return kinds["problem"] > 0


def _printed(finding: Finding, show: int) -> list[str]:
    lines = finding.lines[:show] if show else finding.lines
    more = len(finding.lines) - len(lines)
    return [
        f"{finding.kind}: {finding.title}",
        *(f"    {line}" for line in lines),
        *([f"    and {more} more: --show 0 prints all"] if more else []),
    ]
