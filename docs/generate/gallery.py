"""What the gallery does with what examples leave behind: a film is shown in the page, as a replay shows itself."""

import base64
from pathlib import Path
from typing import Any


class Embedded:
    """Sphinx-Gallery's scraper for .mp4 files that an example has listed in a variable `films`; each is shown once."""

    def __repr__(self) -> str:
        return "Embedded"

    def __call__(self, block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
        """Return the reStructuredText that shows the films."""
        films = block_vars["example_globals"].pop("films", [])
        return "".join(_shown(Path(film)) for film in films)


def _shown(film: Path) -> str:
    data = base64.b64encode(film.read_bytes()).decode("ascii")
    video = f'<video controls loop muted style="max-width: 100%" src="data:video/mp4;base64,{data}"></video>'
    return f"\n.. raw:: html\n\n    {video}\n\n"
