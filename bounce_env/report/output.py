"""Writing a report: the page, the pictures, CSV and JSON, each replaced whole."""

from pathlib import Path

from bounce_env.files import replacing
from bounce_env.report.model import PARTS, Report, write_csv, write_report
from bounce_env.report.page import page_of, pictures_of


def write_all(report: Report, folder: Path) -> None:
    """Write a report to a folder; what an older one has left there, and this one has not, goes."""
    pictures = pictures_of(report)
    page = page_of(report, pictures)
    for name, data in pictures.items():
        with replacing(folder / name) as unfinished:
            unfinished.write_bytes(data)
    for part, rows in report.rows.items():
        write_csv(rows, folder / f"{part}.csv")
    written = {*pictures, *(f"{part}.csv" for part in report.rows)}
    of_reports = {"features.png", "speed.png", *(path.name for path in folder.glob("error_*.png"))}
    for name in {*of_reports, *(f"{part}.csv" for part in PARTS)} - written:
        (folder / name).unlink(missing_ok=True)
    with replacing(folder / "report.html") as unfinished:
        unfinished.write_text(page, encoding="utf-8")
    write_report(report, folder / "report.json")
