"""What players score, from docs/results.csv, which `make results` measured."""

import csv
from pathlib import Path

_RESULTS = Path(__file__).resolve().parent.parent / "results.csv"


def results() -> list[dict[str, str]]:
    """Return the rows of the table."""
    with _RESULTS.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def baselines(game: str = "") -> str:
    """Return what each player scores in a game ("Pinball"), as a table; without a game in all of them."""
    rows = [row for row in results() if row["game"].startswith(game)]
    lines = [
        "| game | player | mean score | 95 % interval | N | a training |",
        "| --- | --- | ---: | ---: | ---: | --- |",
    ]
    for row in rows:
        interval = f"{row['low']} to {row['high']}" if row["low"] else ""
        cells = (row["game"], row["player"], row["score"], interval, row["normalised"], row["training"])
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
