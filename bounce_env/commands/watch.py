"""`watch`."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from bounce_env.commands import games
from bounce_env.commands.cli import FINE, Refused, check_range, say
from bounce_env.commands.options import Watch
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.trained import Agent, load_agent
from bounce_env.window.film import Film
from bounce_env.window.play import play, prepare
from bounce_env.window.session import Session
from bounce_env.wording import counted


def watch_game(options: Watch) -> int:
    """Show the agent's episodes in a window until the person quits, or write a film."""
    env_id = games.game_id(options.game)
    games.check_seed_and_folder(options.seed, options.films)
    if options.episodes is not None:
        check_range("episodes", options.episodes, 1)
    if options.film is not None:
        _check_film(options.film)
    else:
        games.check_display("--film FILE.mp4 writes a film instead")
    agent = _agent(env_id, options)
    if "render_mode" in agent.env_kwargs:
        raise Refused(f"--agent {options.agent}: env_kwargs must not have render_mode")
    kwargs: dict[str, Any] = {"width": options.width, "height": options.height, "trail": options.trail}
    env = games.made(env_id, {**agent.env_kwargs, **kwargs})
    _check_fits(agent, env, options)
    say(f"{env_id}, {_introduced(agent)}; launches of seed {options.seed}")
    prepare(env)
    fps = float(env.metadata["render_fps"])
    try:
        if options.film is not None:
            return _film(env, agent, options, fps)
        return _show(env, agent, options, fps, env_id)
    except OSError as error:  # a disk that is full, a size that no film can have
        raise Refused(f"--film {options.film}: cannot be written: {error}") from error
    finally:
        env.close()


def _show(env: gym.Env[Any, Any], agent: Agent, options: Watch, fps: float, env_id: str) -> int:
    def film() -> Film:
        height, width, _ = session.frame.shape
        return games.new_film(options.films, env_id, (width, height), fps)

    session = Session(env, options.seed, film, agent)
    try:
        play(session, env_id, fps, episodes=options.episodes)
    except load_pygame().error as error:
        raise Refused(f"no window can be opened: {error}; --film FILE.mp4 writes a film instead") from error
    if session.message:
        say(session.message)
    return FINE


def _film(env: gym.Env[Any, Any], agent: Agent, options: Watch, fps: float) -> int:
    """Write the frames of whole episodes."""
    assert options.film is not None
    observation, info = env.reset(seed=options.seed)
    frame: Any = env.render()
    say(f"filming {counted(options.episodes or 1, 'episode')} ...")
    film = Film(options.film, (frame.shape[1], frame.shape[0]), fps)
    film.add(frame)
    for episode in range(options.episodes or 1):
        if episode:
            observation, info = env.reset()
        ended = False
        while not ended:
            observation, _, terminated, truncated, info = env.step(agent(observation))
            ended = terminated or truncated
            frame = env.render()
            film.add(frame)
        say(f"episode {episode + 1}: score {info['score']:g} ({info['end_reason']})")
    film.finish()
    say(f"saved {options.film}")
    return FINE


def _check_film(path: Path) -> None:
    if path.suffix.lower() != ".mp4" or path.is_dir():
        raise Refused(f"--film {path}: must be a file that ends in .mp4")
    if not path.parent.is_dir():
        raise Refused(f"--film {path}: there is no folder {path.parent}")


def _agent(env_id: str, options: Watch) -> Agent:
    try:
        agent = load_agent(env_id) if options.agent is None else Agent.load(options.agent)
    except ValueError as error:
        raise Refused(str(error)) from error
    if agent.env_id != env_id:
        raise Refused(f"--agent {options.agent}: plays {agent.env_id}, not {env_id}")
    return agent


def _check_fits(agent: Agent, env: gym.Env[Any, Any], options: Watch) -> None:
    """Raises Refused where the agent cannot see or play what the environment has."""
    fits = env.observation_space.shape == (agent.size,)
    if not fits or not env.action_space.contains(agent(np.zeros(agent.size, np.float32))):
        env.close()
        raise Refused(f"--agent {options.agent}: was not trained on the observations and actions of this game")


def _introduced(agent: Agent) -> str:
    """Who plays, in a few words."""
    facts = agent.facts
    algo, steps, score = (facts.get(name) for name in ("algo", "steps", "score"))
    words = f"{str(algo or 'agent').upper()}"
    if isinstance(steps, int | float):
        words += f" after {steps / 1e6:.3g} M steps"
    if isinstance(score, dict) and all(isinstance(score.get(name), int | float) for name in ("mean", "low", "high")):
        words += f", mean score {score['mean']:.4g} ({score['low']:.4g} to {score['high']:.4g})"
    return words
