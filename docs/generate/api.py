"""The API pages: signatures as they are written, and docstrings, which are Markdown."""

import ast
import inspect
import re
from collections.abc import Sequence
from copy import deepcopy
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

from generate.public import Public, definition_of, home_of_data, parameters_of, public_names, returned

_CARDS = {
    f"{game}{kind}": f"/environments/{game.lower()}.md"
    for game in ("Pinball", "Paddle", "Walls")
    for kind in ("Env", "VectorEnv")
}
"""The pages of classes whose docstrings are shown there whole."""

DOCS = Path(__file__).resolve().parent.parent

_CITED = re.compile(r"docs/([\w/]+)\.md(?:, (?:section )?\"([^\"]+)\")?")


def api(names: str) -> str:
    """Return what describes public names, each with its members: World, WorldBatch ... with blanks between them."""
    described = {public.path: public for public in _all() if public.owner is None}
    return "\n\n".join(_described(described[name]) for name in names.split())


@cache
def _all() -> tuple[Public, ...]:
    return tuple(public_names())


def source_module(path: str) -> str | None:
    """Return the module whose source a public name is in: what `[source]` shows."""
    public = next((public for public in _all() if public.path == path), None)
    if public is None:
        return None
    if public.kind == "data":
        return home_of_data(public)
    return getattr(public.function, "__module__", None) if public.owner is None else public.owner.__module__


@cache
def title_of(page: str) -> str:
    """Return the first heading of a page of this folder."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    return text.partition("\n")[0].removeprefix("# ")


def linked(doc: str) -> str:
    """Return a docstring in which each page that it cites is a link: docs/physics.md, "Bounce law"."""

    def link(cited: re.Match[str]) -> str:
        anchor = "" if cited[2] is None else "#" + re.sub(r"[^\w -]", "", cited[2].lower()).replace(" ", "-")
        section = "" if cited[2] is None else f": {cited[2]}"
        return f"[{title_of(cited[1])}{section}](/{cited[1]}.md{anchor})"

    return _CITED.sub(link, doc)


def names_of(public: Public) -> list[str]:
    """Return the names of what a callable takes."""
    if public.kind == "class" and not issubclass(public.value, Enum):
        try:
            return list(inspect.signature(public.value).parameters)
        except ValueError:
            return []
    return [name for name, _ in parameters_of(public)] if public.kind in ("function", "method") else []


def with_marked_names(doc: str, names: Sequence[str]) -> str:
    """Return a docstring in which each parameter that it explains stands out: "start, end: its ends"."""
    if not names:
        return doc
    some = "|".join(names)
    explained = re.compile(rf"(?<![\w`(])((?:{some})(?:, (?:{some}))*): ")
    return explained.sub(lambda found: ", ".join(f"`{name}`" for name in found[1].split(", ")) + ": ", doc)


def signature_of(public: Public) -> str:
    """Return the parameters as they are written, annotations and defaults included; nothing of data."""
    if public.kind in ("data", "property", "exception") or (
        public.kind == "class" and issubclass(public.value, Enum)  # made by nobody
    ):
        return ""
    if public.kind != "class":
        result = returned(public)
        return f"({_arguments(public.function)})" + (f" -> {result}" if result else "")
    if "__init__" in vars(public.value) and not hasattr(public.value, "__dataclass_fields__"):
        return f"({_arguments(public.value.__init__)})"
    try:
        parameters = inspect.signature(public.value).parameters.values()
    except ValueError:
        return ""
    return f"({', '.join(str(p.replace(annotation=p.empty)) for p in parameters if p.name not in ('args', 'kwargs'))})"


def _arguments(function: Any) -> str:
    """Return the parameters of a function, but for self and cls, as they are written; of a default that is a constant
    its value.
    """
    arguments = deepcopy(definition_of(function).args)
    arguments.args = [a for a in arguments.args if a.arg not in ("self", "cls")]
    values = {p.name: p.default for p in inspect.signature(function).parameters.values()}
    named = arguments.args[len(arguments.args) - len(arguments.defaults) :]
    arguments.defaults = [_by_value(d, values[a.arg]) for a, d in zip(named, arguments.defaults, strict=True)]
    arguments.kw_defaults = [
        None if d is None else _by_value(d, values[a.arg])
        for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    ]
    return ast.unparse(arguments)


def _by_value(written: ast.expr, value: Any) -> ast.expr:
    return ast.Constant(value) if isinstance(written, ast.Name) and isinstance(value, int | float) else written


def _described(public: Public) -> str:
    members = [member for member in _all() if member.path.startswith(f"{public.path}.")]
    inside = "\n\n".join(_directive(member, member.path.rpartition(".")[2], "````", "") for member in members)
    return _directive(public, public.path, "`````", inside)


def _directive(public: Public, name: str, fence: str, inside: str) -> str:
    options = [f":module: {public.module}"] if public.owner is None else []
    # The pages of sources lead back by one module for all that is in a file.
    back = f'<a id="bounce_env.{name}"></a>\n\n' if public.module == "bounce_env.scene" else ""
    if isinstance(public.value, classmethod):
        options.append(":classmethod:")
    doc = public.doc
    if name in _CARDS:
        doc = doc.split("\n\n")[0] + f"\n\nIts card: [{title_of(_CARDS[name][1:-3])}]({_CARDS[name]})."
    doc = with_marked_names(doc, names_of(public))
    lines = [f"{fence}{{py:{public.kind}}} {name}{signature_of(public)}", *options, "", linked(doc), "", inside]
    return back + "\n".join([*lines, fence])
