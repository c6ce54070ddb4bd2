"""A loop on which only waiting for nothing takes time: no time-out depends on how busy the computer is.

Its time stands still while something is worked on or on its way, and leaps to the next timer once all is
quiet. Sockets and terminals are the real ones; both ends must be served by this loop.
"""

import asyncio
import fcntl
import selectors
import socket
import struct
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import Any

NOT_CONFIRMED, NOT_SENT = 0x5411, 0x894B
"""SIOCOUTQ and SIOCOUTQNSD of Linux: bytes whose arrival is not confirmed, and those that did not leave."""
LOOK_EVERY_S = 0.001
START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)


class _Selector(selectors.PollSelector):
    """Asks every file anew: to poll Linux hands on at once what a terminal was sent, to epoll later."""

    leap: Callable[[float], None]
    others_work: Callable[[], bool]

    def __init__(self) -> None:
        super().__init__()
        self._sentinel = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._sentinel.bind(("127.0.0.1", 0))
        self._sentinel.connect(self._sentinel.getsockname())

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout <= 0.0:
            return super().select(0.0)
        if timeout is None or self.others_work():
            return super().select(None)
        found = super().select(0.0)
        while not found and self._on_its_way():
            found = super().select(LOOK_EVERY_S)
        found = found or super().select(0.0)
        if not found:
            self.leap(timeout)
        return found

    def close(self) -> None:
        self._sentinel.close()
        super().close()

    def _on_its_way(self) -> bool:
        """Return whether a byte has left one end of a connection and not come to the other.

        What was sent to connect or to hang up has come once the loopback has carried a word sent later.
        """
        self._sentinel.send(b".")
        self._sentinel.recv(1)
        files = [key.fd for key in self.get_map().values()]
        if not any(map(_on_the_way, files)):
            return False
        for file in files:
            _confirm(file)
        return any(map(_on_the_way, files))


def _on_the_way(file: int) -> int:
    """Return how many bytes have left a connection and not arrived; whatever is no TCP hands on at once."""
    try:
        return _asked(file, NOT_CONFIRMED) - _asked(file, NOT_SENT)
    except OSError:
        return 0


def _confirm(file: int) -> None:
    """Have a connection confirm at once what it has got: otherwise it would wait for 40 ms."""
    end = socket.socket(socket.AF_INET, socket.SOCK_STREAM, fileno=file)
    with suppress(OSError):
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
    end.detach()


def _asked(file: int, what: int) -> int:
    word = bytearray(4)
    fcntl.ioctl(file, what, word)
    return int(struct.unpack("i", word)[0])


class PatientLoop(asyncio.SelectorEventLoop):
    """Leaps from timer to timer; a thread that works for it is waited for."""

    def __init__(self) -> None:
        self._passed_s = 0.0
        self._in_threads = 0
        selector = _Selector()
        selector.leap, selector.others_work = self._leap, lambda: self._in_threads > 0
        super().__init__(selector)

    def time(self) -> float:
        """Return how long was waited for nothing, in seconds."""
        return self._passed_s

    def run_in_executor(self, executor: Any, func: Callable[..., Any], *args: Any) -> "asyncio.Future[Any]":
        """Have a thread do something; until it has done so no time passes."""
        self._in_threads += 1
        working = super().run_in_executor(executor, func, *args)
        working.add_done_callback(self._one_less)
        return working

    def _one_less(self, done: "asyncio.Future[Any]") -> None:
        self._in_threads -= 1

    def _leap(self, by_s: float) -> None:
        self._passed_s += by_s


class LoopClock:
    """The site's time as the loop that runs has it."""

    def now(self) -> datetime:
        """Return the present instant."""
        return START + timedelta(seconds=asyncio.get_running_loop().time())

    def system_time(self, at: datetime | None = None) -> datetime:
        """Return the same: nobody sets it."""
        return at or self.now()

    async def sleep_until(self, at: datetime) -> None:
        """Sleep for what is left until then."""
        await asyncio.sleep(max(0.0, (at - self.now()).total_seconds()))


def loops(*, patient: bool) -> Mapping[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Return the loop of a test, for the hook `pytest_asyncio_loop_factories` of its folder."""
    return {"patient": PatientLoop} if patient else {"real": asyncio.new_event_loop}
