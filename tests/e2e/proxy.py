"""A network between browser and panel that can go silent without closing anything."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

CHUNK = 65536


class Network:
    """Passes every byte on, or, while it is frozen, keeps every byte and passes it on later."""

    def __init__(self, port: int) -> None:
        self._panel = ("127.0.0.1", port)
        self._flows = threading.Event()
        self._flows.set()
        self._sockets: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def url(self) -> str:
        """Return where a browser finds the panel behind this network."""
        return f"http://127.0.0.1:{self.port}"

    @property
    def port(self) -> int:
        """Return where it listens."""
        return int(self._listener.getsockname()[1])

    def freeze(self) -> float:
        """Let nothing pass from now on, and return when."""
        self._flows.clear()
        return time.monotonic()

    def thaw(self) -> float:
        """Let everything pass that waits, and return when."""
        self._flows.set()
        return time.monotonic()

    def close(self) -> None:
        """Cut every connection."""
        self._flows.set()
        for one in (self._listener, *self._sockets):
            with suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                browser, _ = self._listener.accept()
                threading.Thread(target=self._join, args=(browser,), daemon=True).start()

    def _join(self, browser: socket.socket) -> None:
        self._flows.wait()
        try:
            panel = socket.create_connection(self._panel)
        except OSError:
            browser.close()
            return
        for one in (browser, panel):
            one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._sockets += [browser, panel]
        for ends in ((browser, panel), (panel, browser)):
            threading.Thread(target=self._pump, args=ends, daemon=True).start()

    def _pump(self, source: socket.socket, sink: socket.socket) -> None:
        with suppress(OSError):
            while data := source.recv(CHUNK):
                self._flows.wait()
                sink.sendall(data)
        self._flows.wait()
        for one in (source, sink):
            with suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)


@contextmanager
def network(port: int) -> Iterator[Network]:
    """Put a network before the panel for a while."""
    started = Network(port)
    try:
        yield started
    finally:
        started.close()
