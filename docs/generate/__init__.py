"""What the site takes from the code: each line `{{ name("argument") }}` of a page is replaced by what `name` returns.

Everything that is returned is MyST Markdown; pictures are drawn into docs/_made, beside the pages that show them.
"""

import re
from pathlib import Path
from typing import Any

from generate.api import api, source_module
from generate.baselines import baselines
from generate.cards import card
from generate.mechanisms import mechanisms
from generate.replays import replay
from generate.scene_reference import builtins, elements

_ROOT = Path(__file__).resolve().parent.parent.parent
_CALL = re.compile(r'^\{\{ (\w+)\((?:"([^"]*)")?\) \}\}$', re.MULTILINE)

_PAGES = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "SECURITY.md": "security.md"}
"""Files that lie beside this folder, and the pages that show them."""


def beside(name: str) -> str:
    """Return a file that lies beside this folder, with its links as pages have them."""
    text = (_ROOT / name).read_text(encoding="utf-8").replace("](docs/", "](/")
    for file, page in _PAGES.items():
        text = text.replace(f"]({file}", f"](/{page}")
    return text


_MAKERS = {maker.__name__: maker for maker in (api, baselines, beside, builtins, card, elements, mechanisms, replay)}


def filled(text: str) -> str:
    """Return a page with what the code says in place of the calls in it. Raises KeyError for an unknown one."""
    text = _CALL.sub(lambda call: _MAKERS[call[1]](*filter(None, (call[2],))), text)
    for file, page in _PAGES.items():
        text = text.replace(f"](../{file}", f"](/{page}")
    return text


def setup(app: Any) -> dict[str, Any]:
    """Let Sphinx fill each page before it reads it."""

    def fill(app: Any, name: str, source: list[str]) -> None:
        if Path(app.env.doc2path(name)).suffix == ".md":
            source[0] = filled(source[0])

    app.connect("source-read", fill)
    app.connect("viewcode-follow-imported", lambda app, module, path: source_module(path))
    return {"parallel_read_safe": True}
