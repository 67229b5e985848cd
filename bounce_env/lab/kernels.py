"""Kernels, compiled in processes of their own: the server answers meanwhile, and no tab waits for another.

Run as a module it compiles what it is named, a word and a scene each, and prints the word when that is on disk.
"""

import subprocess
import sys
import threading
from collections.abc import Sequence
from typing import Any

import gymnasium as gym

from bounce_env.lab.ready import DISC, POINT, Wanted
from bounce_env.lab.table import Table
from bounce_env.scene import Ball, Flipper, Scene, Wall
from bounce_env.window.play import prepare


class Kernels:
    """Compiles those of the stage from the start on, and those of a game when it is first wanted."""

    def __init__(self) -> None:
        self._processes: list[subprocess.Popen[str]] = []
        self._lock = threading.Lock()
        self._ready: dict[Wanted, threading.Event] = {}
        self._closed = False
        self._start([POINT, DISC])

    def wait(self, wanted: Wanted) -> None:
        """Return when kernels are on disk, or have failed to be, or all of this has ended."""
        with self._lock:
            if wanted not in self._ready:
                self._start([wanted])
            ready = self._ready[wanted]
        ready.wait()

    def close(self) -> None:
        """End the processes, whatever they have done."""
        with self._lock:
            self._closed = True
            for process in self._processes:
                process.kill()
                process.wait()

    def _start(self, wanted: Sequence[Wanted]) -> None:
        events = [self._ready.setdefault(each, threading.Event()) for each in wanted]
        if self._closed:
            for event in events:
                event.set()
            return
        command = [sys.executable, "-m", "bounce_env.lab.kernels", *(word for each in wanted for word in each)]
        # In a session of its own: Ctrl-C is for the server, which ends it.
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
        self._processes.append(process)
        threading.Thread(target=_follow, args=(process, events), daemon=True).start()


def _follow(process: "subprocess.Popen[str]", events: list[threading.Event]) -> None:
    """Set each event when its line is there, and all at the end."""
    assert process.stdout is not None
    with process.stdout as lines:
        for event, _ in zip(events, lines, strict=False):
            event.set()
    process.wait()
    for event in events:
        event.set()


def compile_world(radius: float) -> None:
    """Do once whatever a tab may ask of a table with a ball of some radius [m]."""
    flipper = Flipper((0.4, 0.5), 0.2, radius=0.02, rest_angle=0.0, active_angle=1.0, up_speed=1.0, down_speed=1.0)
    walls = (Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1)))
    table = Table(Scene(ball=Ball(radius), elements=(*walls, flipper)))
    table.advance(0.1)
    table.drag(0, ((0.0, 0.1), None), 0.01)
    table.press(2, True)
    table.advance(0.01)
    table.place_end(1, 0, (0.0, 1.1))
    table.world.advance_until(1, 0.1)
    table.state()


def compile_game(env_id: str, scene: str) -> None:
    """Play a step of a game, in a scene or its own."""
    import bounce_env  # noqa: F401, PLC0415 (registers the games)

    own: dict[str, Any] = {"scene": scene} if scene else {}
    prepare(gym.make(env_id, disable_env_checker=True, **own))


def compile_wanted(wanted: Wanted) -> None:
    """Compile what is wanted, and keep it on disk."""
    if wanted in (POINT, DISC):
        compile_world(0.0 if wanted == POINT else 0.05)
    else:
        compile_game(*wanted)


if __name__ == "__main__":
    for each in zip(sys.argv[1::2], sys.argv[2::2], strict=True):
        compile_wanted(Wanted(*each))
        sys.stdout.write(f"{each[0]}\n")
        sys.stdout.flush()
