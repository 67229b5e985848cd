"""The window in which a person plays."""

from typing import Any

import gymnasium as gym

from bounce_env.render import Window
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.window.screen import Screen
from bounce_env.window.session import Session


def play(
    session: Session, title: str, fps: float, frames: int | None = None, *, episodes: int | None = None
) -> int:  # fmt: skip
    """Show a session in a window at `fps` frames a second, until the person quits, or after so many frames or episodes.

    Returns how many frames were shown. Raises `pygame.error` where no window can be opened,
    `gymnasium.error.DependencyNotInstalled` without pygame.
    """
    screen = Screen(session)
    window = Window(screen.size, title, fps)
    shown = 0
    try:
        while not (session.quits or window.closed or shown == frames or session.episodes == episodes):
            window.show(screen.draw(session))
            shown += 1
            _pass_on(window, session)
            session.tick()
    finally:
        session.close()
        window.close()
    return shown


def _pass_on(window: Window, session: Session) -> None:
    """What the person did while the last frame was shown."""
    pygame = load_pygame()
    for event in window.events:
        if event.type == pygame.KEYDOWN:
            session.press(pygame.key.name(event.key))
        elif event.type == pygame.KEYUP:
            session.release(pygame.key.name(event.key))


def prepare(env: gym.Env[Any, Any]) -> None:
    """Let the first step compile before there is a window that would not answer."""
    env.reset(seed=0)
    env.step(env.action_space.sample())
