"""The public names of the package, with their docstrings and signatures as they are written."""

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from enum import Enum
from functools import cached_property
from importlib import import_module
from typing import Any, NamedTuple

MODULES = (
    "bounce_env",
    "bounce_env.scene",
    "bounce_env.engine",
    "bounce_env.envs",
    "bounce_env.games",
    "bounce_env.sb3",
)
"""Where public names are: all of `__all__`, and of `bounce_env.sb3`, which has none, its one class."""


class Public(NamedTuple):
    """A public name. path: as a user writes it after the module; owner: the class that it is a member of."""

    module: str
    path: str
    value: Any
    owner: Any = None

    @property
    def kind(self) -> str:
        """Of the directive that describes it: class, exception, method, property, function or data."""
        if inspect.isclass(self.value):
            return "exception" if issubclass(self.value, BaseException) else "class"
        if isinstance(self.value, property | cached_property):
            return "property"
        if self.owner is not None:
            return "method"
        is_function = inspect.isroutine(self.value) or hasattr(self.value, "py_func")
        return "function" if is_function else "data"

    @property
    def function(self) -> Any:
        """The Python function behind it, where there is one: of a property, a class method or a compiled function."""
        value = self.value
        if isinstance(value, property):
            return value.fget
        if isinstance(value, cached_property):
            return value.func
        value = getattr(value, "__func__", value)
        return getattr(value, "py_func", getattr(value, "__wrapped__", value))

    @property
    def is_compiled(self) -> bool:
        """Whether it is one of the functions that games are built of, which kernels call."""
        return self.kind == "function" and self.module == "bounce_env.games" and self.path not in _PYTHON_OF_GAMES

    @property
    def doc(self) -> str:
        """Its docstring; of data the string below its assignment, or the comment behind it."""
        if self.kind == "data":
            return doc_of_data(self)
        return inspect.cleandoc(
            self.function.__doc__ or "" if not inspect.isclass(self.value) else self.value.__doc__ or ""
        )


_PYTHON_OF_GAMES = {"define_game", "function", "options_class", "pace_of"}


def public_names() -> Iterator[Public]:
    """Return each public name once, in the module where it is first met, and behind a class its members."""
    seen: set[int] = set()
    for module in MODULES:
        loaded = import_module(module)
        for name in getattr(loaded, "__all__", ("BounceVecEnv",)):
            value = getattr(loaded, name)
            if name == "__version__" or (id(value) in seen and not isinstance(value, int)):
                continue
            seen.add(id(value))
            public = Public(module, name, value)
            yield public
            if inspect.isclass(value):
                yield from members_of(public)


def members_of(public: Public) -> Iterator[Public]:
    """Return the public methods and properties of a class that it, or a base of ours, defines."""
    cls = public.value
    is_game = cls.__name__.endswith("Env") and cls.__name__ not in _BASES
    if issubclass(cls, Enum) or is_game:  # of a game they are in its base
        return
    shown: set[str] = set()
    for base in cls.__mro__:
        if not base.__module__.startswith("bounce_env"):
            continue
        for name, value in vars(base).items():
            if (name.startswith("_") and name != "__call__") or name in shown or name == "metadata":
                continue
            if isinstance(value, property | cached_property | classmethod | staticmethod) or inspect.isfunction(value):
                shown.add(name)
                yield Public(public.module, f"{public.path}.{name}", value, cls)


_BASES = ("BounceEnv", "BounceVectorEnv", "BounceVecEnv")


def doc_of_data(public: Public) -> str:
    """Return what the module that assigns a constant says of it: a string below, or a comment on its line."""
    return _assigned(public)[1]


def home_of_data(public: Public) -> str | None:
    """Return the module that assigns a constant, None where it is not found."""
    return _assigned(public)[0]


def _assigned(public: Public) -> tuple[str | None, str]:
    """Return the module that assigns a constant, and what it says of it."""
    for module in _homes(public):
        source = inspect.getsource(import_module(module))
        tree = ast.parse(source)
        for node, below in zip(tree.body, [*tree.body[1:], None], strict=True):
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            names = {n.id for t in targets if t is not None for n in ast.walk(t) if isinstance(n, ast.Name)}
            if public.path not in names:
                continue
            if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
                return module, inspect.cleandoc(str(below.value.value))
            comment = re.search(r"#\s*(.*)", source.splitlines()[node.end_lineno - 1])
            if comment:
                return module, comment.group(1)
            above = source.splitlines()[node.lineno - 2]
            return module, above.lstrip("# ") if above.startswith("#") else ""
    return None, ""


def _homes(public: Public) -> Iterator[str]:
    """Return modules in which it may be assigned."""
    loaded = import_module(public.module)
    for table in ("_HOME", "_HOME_OF"):
        home = getattr(loaded, table, {}).get(public.path)
        if home is not None:
            yield home if home.startswith("bounce_env") else f"{public.module}.{home}"
            if not home.startswith("bounce_env"):
                continue
            yield from (f"{home}.features", f"{home}.base", f"{home}.elements")
    yield from (f"{public.module}.features", f"{public.module}.base", f"{public.module}.elements")


def parameters_of(public: Public) -> list[tuple[str, str]]:
    """Return the parameters of a function or method, but for self and cls: name, and annotation as it is written."""
    arguments = definition_of(public.function).args
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    every += [a for a in (arguments.vararg, arguments.kwarg) if a is not None]
    return [
        (a.arg, "" if a.annotation is None else ast.unparse(a.annotation))
        for a in every
        if a.arg not in ("self", "cls")
    ]


def returned(public: Public) -> str:
    """Return the annotation of what a function returns, as it is written."""
    returns = definition_of(public.function).returns
    return "" if returns is None else ast.unparse(returns)


def definition_of(function: Any) -> ast.FunctionDef:
    node = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(node, ast.FunctionDef), function
    return node
