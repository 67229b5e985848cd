"""A replay as one page that stands alone: nothing is loaded from elsewhere, and data is never code."""

import base64
import hashlib
import re
from collections.abc import Mapping
from importlib import resources
from typing import Any

from bounce_env.replay.document import text_of

_FILES = resources.files("bounce_env.replay")


def page_of(document: Mapping[str, Any]) -> str:
    """Return the page that shows a document."""
    style = (_FILES / "page.css").read_text(encoding="utf-8")
    modules = [(_FILES / name).read_text(encoding="utf-8") for name in ("flight.js", "drawing.js", "player.js")]
    script = "\n".join(_without_modules(module) for module in modules)
    parts = {
        "SCRIPT_HASH": _hash(script),
        "STYLE_HASH": _hash(style),
        "STYLE": style,
        "SCRIPT": script,
        "REPLAY": text_of(document),
    }
    page = (_FILES / "page.html").read_text(encoding="utf-8")
    return re.sub("@([A-Z_]+)@", lambda found: parts[found[1]], page)


def _without_modules(script: str) -> str:
    """Return a module's text for a script that holds them all: without imports and exports."""
    script = re.sub(r"^import .*?;\n", "", script, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"^export ", "", script, flags=re.MULTILINE)


def _hash(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
