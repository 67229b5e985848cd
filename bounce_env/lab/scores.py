"""High scores, in the user's data folder: per game, its keywords and its scene."""

import datetime
import hashlib
import json
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from platformdirs import user_data_path
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from bounce_env.files import replacing
from bounce_env.scene import Scene, dump_scene

MOST = 10
"""Scores that are kept of each."""

_LOCK = threading.Lock()


class Score(BaseModel):
    """A game that was played to its end."""

    model_config = ConfigDict(extra="forbid", strict=True)
    score: Annotated[float, Field(allow_inf_nan=False)]
    on: str


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)
    format: Literal[1]
    scores: dict[str, list[Score]]


def key_of(env_id: str, kwargs: Mapping[str, Any], scene: Scene) -> str:
    """Return what scores are compared by."""
    digest = hashlib.sha256(dump_scene(scene).encode()).hexdigest()[:16]
    return f"{env_id} {json.dumps(dict(kwargs), sort_keys=True)} {digest}"


class HighScores:
    """The best scores, in one file of a folder: the user's own where none is given."""

    def __init__(self, folder: Path | None = None) -> None:
        self._path = (user_data_path("bounce_env") if folder is None else folder) / "high_scores.json"

    def of(self, key: str) -> list[Score]:
        """Return the scores of a key, the best first; raises ValueError, naming the file, where it is damaged."""
        return self._read().scores.get(key, [])

    def add(self, key: str, score: float) -> list[Score]:
        """Add a score; returns those that are kept, the best first. Raises as `of`, and OSError."""
        with _LOCK:
            file = self._read()
            new = Score(score=score, on=datetime.datetime.now(datetime.UTC).date().isoformat())
            best = sorted([*file.scores.get(key, []), new], key=lambda entry: -entry.score)[:MOST]
            file.scores[key] = best
            self._path.parent.mkdir(parents=True, exist_ok=True)
            with replacing(self._path) as unfinished:
                unfinished.write_text(file.model_dump_json(indent=1), encoding="utf-8")
            return best

    def _read(self) -> _File:
        try:
            return _File.model_validate_json(self._path.read_bytes())
        except FileNotFoundError:
            return _File(format=1, scores={})
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"])) or "file"
            raise ValueError(f"{self._path}: {place}: {first['msg']}: mend or remove it") from None
