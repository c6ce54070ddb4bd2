"""What counts as silence on the link: nothing heard, not a loop that was too busy to listen."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from app.base.clock import VirtualClock
from app.link.codec import Details, Unasked, encode_telling
from app.link.connection import Connection
from tests.link.test_link import NOON

SILENCE_S = 1.5
TOLD = Details({})


class SkippingLoop(asyncio.SelectorEventLoop):
    """A loop whose time can be put forward, as if it had been busy for so long."""

    skipped_s = 0.0

    def time(self) -> float:
        return super().time() + self.skipped_s


class Heard:
    """Both ends of a connection, and what became of it."""

    def __init__(self) -> None:
        self.peer: asyncio.Future[asyncio.StreamWriter] = asyncio.get_running_loop().create_future()
        self.told: asyncio.Queue[Unasked] = asyncio.Queue()
        self.ended = asyncio.Event()

    async def accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.peer.set_result(writer)
        await reader.read()
        writer.close()


def on_a_busy_loop(path: Path, story: Callable[[Heard, SkippingLoop], Awaitable[None]]) -> None:
    async def connected() -> None:
        loop, heard = asyncio.get_running_loop(), Heard()
        assert isinstance(loop, SkippingLoop)
        async with await asyncio.start_unix_server(heard.accept, path):
            connection = Connection(
                path,
                VirtualClock(NOON),
                hear=heard.told.put_nowait,
                end=heard.ended.set,
                silence_s=SILENCE_S,
            )
            connection.start()
            peer = await heard.peer
            peer.write(encode_telling(TOLD))
            await heard.told.get()
            try:
                async with asyncio.timeout(60):
                    await story(heard, loop)
            finally:
                await connection.close()
                await peer.wait_closed()

    with asyncio.Runner(loop_factory=SkippingLoop) as runner:
        runner.run(connected())


def test_what_came_while_the_loop_was_busy_is_heard(tmp_path: Path) -> None:
    async def story(heard: Heard, loop: SkippingLoop) -> None:
        peer = await heard.peer
        for _ in range(3):
            peer.write(encode_telling(TOLD))
            loop.skipped_s += 4 * SILENCE_S
            assert await heard.told.get() == TOLD
        assert not heard.ended.is_set()

    on_a_busy_loop(tmp_path / "link", story)


def test_a_line_on_which_nothing_came_has_ended(tmp_path: Path) -> None:
    async def story(heard: Heard, loop: SkippingLoop) -> None:
        loop.skipped_s += SILENCE_S
        await heard.ended.wait()

    on_a_busy_loop(tmp_path / "link", story)
