"""A connection without a network: what the server did with its end of the wire, and its timers."""

import asyncio
from collections.abc import Callable
from typing import Any

import uvicorn
from uvicorn.server import ServerState

from app.base.clock import Clock, SystemClock
from app.base.turnstile import Turnstile
from app.web.http.server import CautiousHttp, Connections, cautious
from app.web.live.live_protocol import CautiousSocket, cautious_sockets

FAR = "192.0.2.7"


class Wire(asyncio.Transport):
    """The server's end of a connection; what it wrote lies in `written`."""

    def __init__(self, client: str = FAR, raw: Any = None) -> None:
        super().__init__()
        self.extra = {"peername": (client, 50000) if client else None, "sockname": ("127.0.0.1", 8000)}
        self.extra |= {"socket": raw}
        self.written = bytearray()
        self.closed = self.aborted = False
        self.reads = True
        self.protocol: Any = None

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        return self.extra.get(name, default)

    def write(self, data: Any) -> None:
        assert not self.is_closing(), "nothing is written to what is closed"
        self.written += data

    def close(self) -> None:
        self.closed = True

    def abort(self) -> None:
        self.aborted = True

    def is_closing(self) -> bool:
        return self.closed or self.aborted

    def pause_reading(self) -> None:
        assert self.reads, "it is paused once"
        self.reads = False

    def resume_reading(self) -> None:
        assert not self.reads, "it is resumed once"
        self.reads = True

    def set_protocol(self, protocol: Any) -> None:
        self.protocol = protocol


class Timer:
    """Something that is to be done after a while."""

    def __init__(self, after_s: float, work: Callable[[], object]) -> None:
        self.after_s, self.work, self.cancelled = after_s, work, False

    def cancel(self) -> None:
        """Do not do it."""
        self.cancelled = True


class Timers:
    """A loop that notes what is to be done later and does it when a test says so."""

    def __init__(self) -> None:
        self.set: list[Timer] = []

    def call_later(self, after_s: float, work: Callable[[], object]) -> Timer:
        """Note it."""
        self.set.append(Timer(after_s, work))
        return self.set[-1]

    def create_task(self, work: Any, **about: Any) -> asyncio.Task[Any]:
        """Begin it at once, as the loop does."""
        return asyncio.get_running_loop().create_task(work, **about)

    def time(self) -> float:
        """Return when it is."""
        return 0.0

    @property
    def left(self) -> list[Timer]:
        """Return what is still to be done."""
        return [timer for timer in self.set if not timer.cancelled]


class Wired:
    """uvicorn's protocols around an application, and the connections made to them."""

    def __init__(
        self,
        app: Any,
        connections: Connections | None = None,
        clock: Clock | None = None,
        deadline_s: float | None = None,
    ) -> None:
        self.state, self.timers = ServerState(), Timers()
        self.connections = connections or Connections(100)
        turnstile = Turnstile()
        http = cautious(self.connections, turnstile, *(() if deadline_s is None else (deadline_s,)))
        ws = cautious_sockets(clock or SystemClock(), turnstile)
        self.config = uvicorn.Config(app, http=http, ws=ws, log_config=None, lifespan="off")
        self.config.load()

    def http(self, wire: Wire) -> CautiousHttp:
        """Connect, as a browser does."""
        kind: Any = self.config.http_protocol_class
        made: CautiousHttp = kind(self.config, self.state, {"of": "the server"}, self.timers)
        made.connection_made(wire)
        return made

    def socket(self, wire: Wire) -> CautiousSocket:
        """Connect to what is a WebSocket already."""
        kind: Any = self.config.ws_protocol_class
        made: CautiousSocket = kind(self.config, self.state, {"of": "the server"}, self.timers)
        made.connection_made(wire)
        return made


async def turns(count: int = 5) -> None:
    """Let everything that is ready go on."""
    for _ in range(count):
        await asyncio.sleep(0)
