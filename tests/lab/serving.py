"""A lab's server that runs while a test does."""

import threading
import time
from contextlib import contextmanager

from bounce_env.lab.server import Server


@contextmanager
def serving(folder, **options):
    """Give a server that answers; it has ended when the test goes on."""
    server = Server(folder=folder, **options)
    thread = threading.Thread(target=server.run)
    thread.start()
    deadline = time.monotonic() + 30.0
    while not server.started and time.monotonic() < deadline:
        time.sleep(0.01)
    try:
        yield server
    finally:
        server.stop()
        thread.join(30.0)
        assert not thread.is_alive()
