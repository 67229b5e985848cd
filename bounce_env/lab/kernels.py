"""Kernels for the stage, compiled in a process of its own: the server answers meanwhile, and no tab waits for another.

Run as a module it compiles what the stage needs and prints the name of each kind that is on disk now.
"""

import subprocess
import sys
import threading
from typing import TypeAlias

from bounce_env.lab.table import Table
from bounce_env.scene import Ball, Flipper, Scene, Wall

Kind: TypeAlias = str

POINT, DISC = "point", "disc"
"""Balls without a radius, and with one, have kernels of their own."""


def kind_of(scene: Scene) -> Kind:
    """Return which kernels a scene needs."""
    return POINT if scene.ball.radius == 0.0 else DISC


class Kernels:
    """Compiles kernels from the start on; `wait` returns when those of a kind are on disk, or have failed to be."""

    def __init__(self) -> None:
        self._ready = {POINT: threading.Event(), DISC: threading.Event()}
        command = [sys.executable, "-m", "bounce_env.lab.kernels"]
        # In a session of its own: Ctrl-C is for the server, which ends it.
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
        threading.Thread(target=self._follow, daemon=True).start()

    def wait(self, scene: Scene) -> None:
        """Return when a scene needs no compiler any more."""
        self._ready[kind_of(scene)].wait()

    def close(self) -> None:
        """End the process, whatever it has done."""
        self._process.kill()
        self._process.wait()

    def _follow(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                self._ready[line.strip()].set()
        for ready in self._ready.values():
            ready.set()


def compile_for(radius: float) -> None:
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


if __name__ == "__main__":
    for kind, ball_radius in ((POINT, 0.0), (DISC, 0.05)):
        compile_for(ball_radius)
        sys.stdout.write(f"{kind}\n")
        sys.stdout.flush()
