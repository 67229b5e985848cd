"""A page for each environment: its card, and what the card leaves to the code, number by number."""

import inspect
import re
from typing import Any

import gymnasium as gym

import bounce_env
from bounce_env.envs.observations import ViewOptions
from bounce_env.registration import short_name
from bounce_env.scene.fields import Allowed
from generate.api import linked
from generate.baselines import baselines
from generate.pictures import film

_HEADINGS = {
    "Action": "Actions",
    "Actions": "Actions",
    "Points": "Points",
    "Observation": "Observation",
    "Levels": "Levels",
    "Reward": "Reward",
    "Start": "Start",
    "End": "End",
    "Info": "Info",
    "Keyword arguments": "",
    "Versions": "Versions",
}
"""With what a paragraph of a card begins, and the heading that it gets."""


def card(env_id: str) -> str:
    """Return the page of an environment, below its title."""
    env: Any = gym.make(env_id).unwrapped
    doc = inspect.cleandoc(type(env).__doc__)
    name = type(env).__name__.removesuffix("Env")
    return "\n\n".join(
        [
            f"![A trained agent plays {env_id}]({film(env_id)})",
            _facts(env, env_id),
            linked(_with_headings(doc)),
            "## Observation, index by index",
            f'What `gym.make("{env_id}").unwrapped.observed` says: of the built-in scene, with default keywords.',
            observation_table(env),
            *(_levels(env_id) if "num_levels" in env.defaults() else []),
            "## Keyword arguments",
            _keywords(env),
            "## Baselines",
            baselines(name),
            "How they were measured, and what N is: [training and protocol](/training.md).",
        ]
    )


def _facts(env: Any, env_id: str) -> str:
    module = f"{type(env).__module__}:{type(env).__name__}"
    agent = f'`bounce_env.load_agent("{env_id}")`; `bounce-env watch {short_name(env_id)}`'
    rows = {
        "make": f'`gym.make("{env_id}")`, `gym.make_vec("{env_id}", ..., vectorization_mode="vector_entry_point")`',
        "action space": f"`{env.action_space}`",
        "observation space": f"`Box({env.observation_space.shape}, float32)`",
        "class": f"`{module}`",
        "trained agent": agent,
    }
    return "| | |\n| --- | --- |\n" + "\n".join(f"| {key} | {value} |" for key, value in rows.items())


def _with_headings(doc: str) -> str:
    """Return a card with a heading in place of the word that each part of it begins with."""
    paragraphs = []
    for paragraph in doc.split("\n\n"):
        word = re.match(r"(Keyword arguments|[A-Z][a-z]+)[,:] ", paragraph)
        if word is None or word[1] not in _HEADINGS:
            paragraphs.append(paragraph)
        elif word[1] != "Keyword arguments":  # they are in a table of their own
            rest = paragraph[word.end() :]
            paragraphs += [f"## {_HEADINGS[word[1]]}", rest if rest.startswith("v0") else rest[0].upper() + rest[1:]]
    return "\n\n".join(paragraphs)


def observation_table(env: Any) -> str:
    """Return what each number of an observation is."""
    lines = ["| index | what | unit | from | to |", "| ---: | --- | --- | ---: | ---: |"]
    lines += [f"| {i} | {o.what} | {o.unit} | {o.low:.4g} | {o.high:.4g} |" for i, o in enumerate(env.observed)]
    return "\n".join(lines)


def _levels(env_id: str) -> list[str]:
    return [
        "With levels, as `num_levels=200`:",
        observation_table(gym.make(env_id, num_levels=200).unwrapped),
    ]


_OF_VECTORS = {
    "num_envs": "a whole number >= 1",
    "max_episode_steps": "None, or a whole number >= 1",
    "num_threads": "a whole number >= 1",
    "autoreset_mode": '"NEXT_STEP", "SAME_STEP" or "DISABLED"',
    "copy": "True or False; whether a step's observations are arrays of their own",
    "info": '"all", "ends" or "none"',
}
"""What the keywords take that vector environments have beside those of single ones."""


def _keywords(env: Any) -> str:
    told = keyword_meanings(inspect.cleandoc(type(env).__doc__)) | {"scene": ""}
    allowed = allowed_words(type(env).game_type.options_type) | allowed_words(ViewOptions)
    vector = bounce_env.envs.vector_env_of(type(env)).defaults()
    lines = ["| keyword | default | what it takes |", "| --- | --- | --- |"]
    for name, default in env.defaults().items():
        checked, said = allowed.get(name, ""), _without_default(told.get(name, ""), default)
        are_listed = checked and re.fullmatch(r'(?:"\w+"(?:, )?)+', said)
        words = "; ".join(filter(None, (checked, "" if are_listed else said)))
        lines.append(f"| `{name}` | `{default!r}` | {words} |")
    for name, words in _OF_VECTORS.items():
        shown = getattr(vector[name], "name", vector[name])
        lines.append(f"| `{name}` (vector environments) | `{shown!r}` | {words} |")
    return "\n".join(lines)


def _without_default(words: str, default: Any) -> str:
    """Return what a card says of a keyword after its default, which stands first: "120.0 s, None for none"."""
    return re.sub(rf'^"?{re.escape(str(default))}"?(?: s)?(?:[,;] |$)', "", words)


def allowed_words(options: Any) -> dict[str, str]:
    """Return what the checks of a class of options say that each field takes."""
    fields = options.__pydantic_fields__
    words = {n: next((m.words for m in f.metadata if isinstance(m, Allowed)), "") for n, f in fields.items()}
    return {name: text.replace("|", "\\|") for name, text in words.items()}


def keyword_meanings(doc: str) -> dict[str, str]:
    """Return what a card says of each keyword: "`balls` (3), `width`, `height` (of a frame, pixels)"."""
    paragraph = " ".join(next(p for p in doc.split("\n\n") if p.startswith("Keyword arguments:")).split())
    told = {}
    for words, meaning in re.findall(r"((?:`\w+`, )*`\w+`) \(((?:[^()]|\([^()]*\))*)\)", paragraph):
        for name in re.findall(r"`(\w+)`", words):
            told[name] = meaning.replace("|", "\\|")
    return told
