"""Training configs: YAML in the RL Zoo's format, one entry per environment id; checked strictly, never evaluated."""

import math
from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from agents.command import Refused
from bounce_env.scene.fields import Allowed
from bounce_env.wording import nearest, shown

Model = TypeVar("Model", bound=BaseModel)

LARGEST_SEED = 2**32 - 1
"""NumPy's global generator, which SB3 seeds, takes no larger one."""


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError
    return value


def _where(holds: Callable[[float], bool]) -> Callable[[Any], float]:
    def convert(value: Any) -> float:
        if not holds(_number(value)):
            raise ValueError
        return value

    return convert


def _count(value: Any) -> int:
    """Return a whole number, which may be written as 1.0e+6."""
    if _number(value) < 1 or value != int(value):
        raise ValueError
    return int(value)


def _seed(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= LARGEST_SEED:
        raise ValueError
    return value


def _layers(value: Any) -> list[int] | dict[str, list[int]]:
    if isinstance(value, dict):
        if set(value) != {"pi", "vf"}:
            raise ValueError
        return {name: [_count(units) for units in layers] for name, layers in value.items()}
    return [_count(units) for units in value]


def _schedule(value: Any) -> float | str:
    number = float(value.removeprefix("lin_")) if isinstance(value, str) else value
    if _number(number) <= 0.0 or (isinstance(value, str) and not value.startswith("lin_")):
        raise ValueError
    return value


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


# What a value may be, and the words that an error says it with. YAML 1.1 reads 1e-3 as text, hence the spelling.
Count = Annotated[int, Allowed("a whole number >= 1 (a large one may be written 1.0e+6)", _count)]
Seed = Annotated[int, Allowed(f"a whole number from 0 to {LARGEST_SEED}", _seed)]
Number = Annotated[float, Allowed("a number", _number)]
Positive = Annotated[float, Allowed("a number > 0", _where(lambda x: x > 0.0))]
NotNegative = Annotated[float, Allowed("a number >= 0", _where(lambda x: x >= 0.0))]
Share = Annotated[float, Allowed("a number from 0 to 1", _where(lambda x: 0.0 <= x <= 1.0))]
Flag = Annotated[bool, Allowed("true or false", _flag)]
Schedule = Annotated[
    float | str, Allowed("a number > 0 such as 1.0e-3, or lin_1e-3 to fall linearly from there to 0", _schedule)
]
Layers = Annotated[Any, Allowed("a list of whole numbers >= 1, or {pi: such a list, vf: such a list}", _layers)]


class Strict(BaseModel):
    """Frozen; unknown keys and values of another type are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class _Loader(yaml.SafeLoader):
    """Plain YAML, in which a key given twice is an error."""

    def construct_mapping(self, node: yaml.MappingNode, deep: Flag = False) -> dict[Hashable, Any]:
        keys = [key.value for key, _ in node.value if key.value != "<<"]
        twice = next((key for key in keys if keys.count(key) > 1), None)
        if twice is not None:
            raise yaml.constructor.ConstructorError(None, None, f"key {twice!r} is given twice", node.start_mark)
        return super().construct_mapping(node, deep)


def read_yaml(path: Path) -> dict[str, Any]:
    """Return the mapping in a YAML file; raises Refused, naming file and line, where there is none."""
    try:
        data = yaml.load(path.read_bytes(), _Loader)
    except OSError as error:
        raise Refused(f"{path}: cannot be read: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise Refused(f"{path}: is not YAML: {str(error).replace('<byte string>', path.name)}") from None
    if not isinstance(data, dict):
        raise Refused(f"{path}: must be a mapping from environment ids to hyperparameters")
    return data


def load_config(path: Path, env_id: str, overrides: Mapping[str, Any], model: type[Model]) -> Model:
    """Return the entry of `env_id` in a config file, as a `model`; `overrides` take the place of what it says.

    Raises Refused: one line for each thing that is wrong, with file, id, key, value and what is allowed.
    """
    data = read_yaml(path)
    if env_id not in data:
        hint = nearest(env_id, map(str, data))
        raise Refused(f"{path}: has no entry {env_id!r}; it has {', '.join(map(str, data)) or 'none'}{hint}")
    entry = data[env_id]
    return checked(model, {**entry, **overrides} if isinstance(entry, dict) else entry, f"{path}: {env_id}")


def checked(model: type[Model], data: Any, where: str) -> Model:
    """`data` as a `model`; raises Refused, beginning with `where`, for all that is wrong in it."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        lines = [f"{where}: {_explained(model, dict(details))}" for details in error.errors()]
        raise Refused("\n".join(lines)) from None


def _explained(model: type[BaseModel], details: Mapping[str, Any]) -> str:
    key, kind = ".".join(map(str, details["loc"])), details["type"]
    if kind == "missing":
        return f"{key}: must be given"
    if kind == "extra_forbidden":
        for name in details["loc"][:-1]:
            model = model.model_fields[name].annotation
        hint = nearest(str(details["loc"][-1]), model.model_fields)
        return f"unknown key {key!r}{hint}: must be one of {', '.join(model.model_fields)}"
    message = details["msg"].removeprefix("Value error, ")
    if kind in ("model_type", "dict_type"):
        message = "must be a mapping"
    elif kind == "literal_error":
        message = f"must be {details['ctx']['expected']}"
    elif kind == "string_type":
        message = "must be text"
    return f"{key} = {shown(details['input'])}: {message}" if key else message
