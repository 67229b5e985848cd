"""Compile what advances a batch, and tell which of the engine's files have code in it.

`python -m tests.report.compiled_functions FEATURE...` prints them, in JSON, with the bytes of machine code.
"""

import importlib
import json
import pkgutil
import sys

from numba.core.dispatcher import Dispatcher

import bounce_env.engine
from bounce_env.report.features import compile_alone


def modules_with_code() -> list[str]:
    """Return the engine's modules of which a function has been compiled in this process."""
    found = []
    for info in pkgutil.walk_packages(bounce_env.engine.__path__, "bounce_env.engine."):
        module = importlib.import_module(info.name)
        own = [f for f in vars(module).values() if isinstance(f, Dispatcher) and f.py_func.__module__ == info.name]
        if any(f.overloads for f in own):
            found.append(info.name.removeprefix("bounce_env.engine."))
    return found


if __name__ == "__main__":
    _, size = compile_alone(sys.argv[1:])
    sys.stdout.write(json.dumps([size, modules_with_code()]))
