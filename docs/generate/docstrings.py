"""What the docstring of a public name has to say: parameters, errors, shapes, units, and its source."""

import re

from generate.public import Public, parameters_of, public_names, returned

_SOURCE = re.compile(r"docs/[\w/]+\.md|[Tt]utorial|tests/[\w/]+\.py|Gymnasium|Stable-Baselines3|SB3")
_SHAPE = re.compile(r"\(\w[\w ]*, ?[\w ]*\)|\(\w+,\)|shape|one for each|one row")
_UNIT = re.compile(r"\bm/s|\bmetres|\bseconds|\[m\]|\[s\]|\brad|\[|0 to 1|-1 to 1|share|number|float")
_ERRORS = re.compile(r"\b[Rr]aises?\b|Error")


def lacks(public: Public, docs: dict[str, str]) -> list[str]:
    """Return what is missing in the docstring of a public name: parameters, errors, shapes, units, its source.

    docs: the docstring of each class by its path, which may say it for its members.
    """
    doc = public.doc
    if len(doc.split()) < 3:
        return ["docstring"]
    told = doc + " " + docs.get(public.path.partition(".")[0], "")
    problems = []
    if public.kind in ("function", "method"):
        parameters = [(name, annotation) for name, annotation in parameters_of(public) if name not in explained(public)]
        problems += [f"parameter {name}" for name, _ in parameters if not re.search(rf"\b{name}\b", told)]
        if parameters and not public.is_compiled and not _ERRORS.search(told):
            problems.append("errors")
        annotations = " ".join(annotation for _, annotation in parameters) + " " + returned(public)
        if re.search(r"NDArray|ArrayLike|Floats|Array\b", annotations) and not _SHAPE.search(told):
            problems.append("shape")
        if re.search(r"NDArray|ArrayLike|Floats|Array\b|\bfloat\b", annotations) and not _UNIT.search(told):
            problems.append("unit")
    is_of_a_page = public.kind == "data" or public.is_compiled  # all together: the page of games names their source
    if public.owner is None and not is_of_a_page and not _SOURCE.search(doc):
        problems.append("source")
    return problems


def explained(public: Public) -> set[str]:
    """Return the parameters that the page of games explains once, for all functions that kernels call."""
    return {"state", "game", "w", "k", "m", "episode", "action"} if public.is_compiled else set()


def missing_in_docstrings() -> list[str]:
    """Return each public name of which a docstring says too little, with what it leaves out."""
    names = list(public_names())
    docs = {public.path: public.doc for public in names if public.owner is None}
    return [
        f"{public.module}.{public.path}: {', '.join(problems)}" for public in names if (problems := lacks(public, docs))
    ]
