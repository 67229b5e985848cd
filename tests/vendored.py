"""Files of others that we ship: unchanged, each with its licence, and none that is not listed."""

import tomllib
from hashlib import sha256
from pathlib import Path

LICENCES = {"MIT": "Permission is hereby granted", "Apache-2.0": "Apache License"}
"""Words that are in the text of a licence."""


def check_vendored(folder: Path) -> None:
    """Fail where a file in a folder is not what its vendored.toml says."""
    rows = tomllib.loads((folder / "vendored.toml").read_text())["file"]
    for row in rows:
        text = (folder / row["path"]).read_bytes()
        assert sha256(text).hexdigest() == row["sha256"], row["path"]
        assert LICENCES[row["licence"]] in (folder / row["licence_file"]).read_text()
        assert row["path"].endswith("uPlot.min.css") or row["version"].encode() in text
    known = {name for row in rows for name in (row["path"], row["licence_file"])}
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert there == {*known, "vendored.toml"}
