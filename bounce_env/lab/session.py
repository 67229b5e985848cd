"""A tab that is open: its messages, answered one after the other."""

import asyncio
import json
import sys
from collections.abc import Mapping
from concurrent.futures import Executor, Future
from contextlib import suppress
from typing import Any

from starlette.websockets import WebSocket, WebSocketState

from bounce_env.lab.rooms import Room

MOST_WAITING = 64
"""Messages that may wait for an answer: a page sends one at a time."""


class Session:
    """Answers what a tab sends, in a thread: what takes long is no reason for others to wait.

    It ends as soon as the tab is closed. What is being answered then goes on to its end, and the room is closed after
    that.
    """

    def __init__(self, tab: WebSocket, room: Room, threads: Executor) -> None:
        self._tab, self._room, self._threads = tab, room, threads
        self._messages: asyncio.Queue[str] = asyncio.Queue(MOST_WAITING)
        self._running: Future[Any] | None = None

    async def serve(self) -> None:
        """Return when the tab is closed."""
        answering = asyncio.ensure_future(self._answer())
        reading = asyncio.ensure_future(self._read())
        try:
            await asyncio.wait([answering, reading], return_when=asyncio.FIRST_COMPLETED)
        finally:
            answering.cancel()
            reading.cancel()
            self._close_when_done()

    async def _read(self) -> None:
        while True:
            message = await self._tab.receive()
            if message["type"] == "websocket.disconnect":
                return
            await self._messages.put(message.get("text") or "")  # bytes are no message

    async def _answer(self) -> None:
        while True:
            text = await self._messages.get()
            self._running = self._threads.submit(answered, self._room, text)
            answer = await asyncio.wrap_future(self._running)
            if self._tab.client_state is not WebSocketState.CONNECTED:
                return
            await self._tab.send_text(json.dumps(answer, separators=(",", ":"), allow_nan=False))

    def _close_when_done(self) -> None:
        def close(_: object) -> None:
            with suppress(ValueError):  # nobody is there to be told
                self._room.close()

        if self._running is None:
            close(None)
        else:
            self._running.add_done_callback(close)


def answered(room: Room, text: str) -> Mapping[str, Any]:
    """Return a room's answer to a message; what is wrong with a message is an answer, too."""
    try:
        return room.answer(text)
    except ValueError as error:
        return {"error": str(error)}
    except Exception as error:  # the tab is told, and goes on; the person at the terminal sees where it comes from
        sys.excepthook(type(error), error, error.__traceback__)
        return {"error": f"the lab has failed: {type(error).__name__}: {error}"}
