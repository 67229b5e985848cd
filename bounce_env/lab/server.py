"""The lab's server: a few files, and a WebSocket for each tab."""

import asyncio
import socket
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket

from bounce_env.lab.guard import LOCAL, Guard
from bounce_env.lab.ready import Ready, at_once
from bounce_env.lab.rooms import ROOMS, Room
from bounce_env.lab.session import Session

MOST_SESSIONS = 8
THREADS = 64
LARGEST_MESSAGE = 1_000_000  # bytes

BUSY = 1013  # WebSocket's code: try again later

_TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css"}
_VENDORED = ("pico.min.css", "uPlot.iife.min.js", "uPlot.min.css")
FILES = {
    **{f"/{file.name}": file for file in (resources.files("bounce_env.lab") / "pages").iterdir()},
    **{f"/{name}": resources.files("bounce_env.lab") / "vendor" / name for name in _VENDORED},
    **{f"/{name}": resources.files("bounce_env.replay") / name for name in ("flight.js", "drawing.js")},
}
"""What is served, and nothing else: by its path."""

PAGES = {"/": "/index.html", **{f"/{name}": f"/{name}.html" for name in ROOMS}}
"""Paths of pages, and which file each is."""


class Server:
    """Serves the lab.

    folder: the only one in which it reads and writes files. scene: of the stage at first. host, port: where it listens;
    port 0: a free one. ready: returns when kernels are there. Raises OSError where it cannot listen.
    """

    def __init__(
        self,
        *,
        folder: Path,
        scene: str | None = None,
        host: str = "127.0.0.1",
        port: int = 0,
        ready: Ready = at_once,
    ) -> None:
        self._given: dict[str, Any] = {"folder": folder, "scene": scene, "ready": ready}
        self._sessions = 0
        routes = [
            *(Route(path, self._file(FILES[page])) for path, page in PAGES.items()),
            *(Route(path, self._file(file)) for path, file in FILES.items() if file.name.endswith((".js", ".css"))),
            *(WebSocketRoute(f"/{name}/socket", self._talk(room)) for name, room in ROOMS.items()),
        ]
        family = socket.AF_INET6 if host.startswith("[") else socket.AF_INET
        self._socket = socket.create_server((host.strip("[]"), port), family=family)
        self.port = self._socket.getsockname()[1]
        everywhere = host in ("0.0.0.0", "[::]")  # then the address that people use is another one
        self._host = socket.gethostname() if everywhere else host
        hosts = LOCAL if host in LOCAL else (*LOCAL, host, self._host, socket.getfqdn())
        self._guard = Guard(Starlette(routes=routes), hosts, f"bounce_lab_{self.port}", by_address=everywhere)
        # Threads that wait for kernels block no tab that does not.
        self._threads = ThreadPoolExecutor(THREADS)
        # No pings: while a kernel is compiled nothing answers them.
        config = uvicorn.Config(
            self._guard, ws="websockets-sansio", ws_max_size=LARGEST_MESSAGE, ws_ping_interval=None, lifespan="off",
            log_level="critical", access_log=False, server_header=False, timeout_graceful_shutdown=1,
        )  # fmt: skip
        self._uvicorn = uvicorn.Server(config)

    def address(self, room: str = "") -> str:
        """Return the first address, which lets a browser in."""
        return f"http://{self._host}:{self.port}/{room}?token={self._guard.token}"

    def run(self) -> None:
        """Serve until Ctrl-C, or `stop`."""
        self._uvicorn.run(sockets=[self._socket])
        self._threads.shutdown(wait=False, cancel_futures=True)

    def stop(self) -> None:
        """End all sessions, and `run`; may be called from another thread."""
        self._uvicorn.should_exit = True

    @property
    def started(self) -> bool:
        """Whether it answers."""
        return self._uvicorn.started

    @staticmethod
    def _file(file: Traversable) -> Callable[[Request], Any]:
        async def answer(request: Request) -> Response:
            return Response(file.read_bytes(), media_type=_TYPES[Path(file.name).suffix])

        return answer

    def _talk(self, room: type[Room]) -> Callable[[WebSocket], Any]:
        async def talk(tab: WebSocket) -> None:
            await tab.accept()
            if self._sessions >= MOST_SESSIONS:
                await tab.close(BUSY, f"{MOST_SESSIONS} tabs are open, and no more may be: close one")
                return
            self._sessions += 1
            session = Session(tab, room(**self._given), self._threads)
            try:
                await session.serve()
            except asyncio.CancelledError:
                pass  # the lab ends
            finally:
                self._sessions -= 1

        return talk
