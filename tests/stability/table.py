"""All outcomes of the stability suite as a table: `python -m tests.stability.table outcomes.csv` (or .json).

One row for each thing that a case expects: case, what, expected, seen, error and tolerance (SI units; for what is no
number 0 is right and 1 is wrong), verdict, the status of the ball, and where the right answer comes from.
"""

import argparse
import csv
import json
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.stability.stability_case import judge, play
from tests.stability.stability_cases import CASES

FIELDS = ("case", "what", "expected", "seen", "error", "tolerance", "verdict", "status", "why")


def outcomes(pattern: str = "") -> Iterator[dict[str, str | float]]:
    """Rows of the table, of the cases whose name contains `pattern`."""
    for case in CASES:
        if pattern not in case.name:
            continue
        run = play(case)
        for item in judge(case, run):
            verdict = "right" if item.right else "wrong"
            status = "REFUSED" if run.refusal else run.status
            values = (
                case.name,
                item.what,
                item.expected,
                item.seen,
                item.error,
                item.within,
                verdict,
                status,
                case.why,
            )
            yield dict(zip(FIELDS, values, strict=True))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path, help="where to write, .csv or .json")
    parser.add_argument("--only", default="", metavar="TEXT", help="cases whose name contains this")
    arguments = parser.parse_args()
    rows = list(outcomes(arguments.only))
    with arguments.file.open("w", newline="") as file:
        if arguments.file.suffix == ".json":
            json.dump(rows, file, indent=1)
        else:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(rows)
    wrong = sorted({str(row["case"]) for row in rows if row["verdict"] == "wrong"})
    cases = len({row["case"] for row in rows})
    sys.stdout.write("\n".join([f"{cases} cases, {len(rows)} outcomes, {len(wrong)} cases wrong", *wrong]) + "\n")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
