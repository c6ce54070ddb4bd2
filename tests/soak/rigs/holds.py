"""Many buttons held at once without a browser and let go in every way, measured at the drives themselves."""

import asyncio
import gc
import os
import random
import signal
import subprocess
import sys
import tempfile
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from tests.e2e.integrator import Integrator
from tests.e2e.product import Product, end
from tests.e2e.socket_page import LetGo, Page
from tests.patience import eventually
from tests.soak.rigs.drive_farm import Watched, farm, keep_punctual
from tests.soak.rigs.held_press import Press

ONE_BY_ONE = (LetGo.RELEASED, LetGo.CLOSED, LetGo.HIDDEN, LetGo.CUT, LetGo.KILLED)
"""What is done to one button while the others are held on."""
BEAT_S = 0.05
BEATS = (3, 6)
PAUSE_S = (0.06, 0.12)
RIG_LATE_S = 0.1
"""A heartbeat that this program sends so late after the one before is no sign of a button that is held."""
FROZEN_S = {"web": 0.6, "controller": 0.8}


@dataclass
class Tally:
    """What became of the presses."""

    took_ms: dict[LetGo, list[float]] = field(default_factory=dict)
    held: int = 0
    refused: int = 0
    stopped_by_itself: int = 0
    not_held: int = 0
    moved_again: int = 0
    why: list[str] = field(default_factory=list)

    def count(self, way: LetGo, took_s: float) -> None:
        """Count one press that was let go."""
        self.took_ms.setdefault(way, []).append(took_s * 1000.0)


@dataclass
class Button:
    """One tracker's button, the page it is on, and the drive behind it."""

    page: Page
    drive: Watched
    tally: Tally
    product: Product
    presses: int = 0

    async def take_control(self) -> None:
        """Press for a moment: the first press of a page waits until its control is on the disk."""
        press = self._press()
        await self.page.beat(press.press_id, 1, 0)
        await eventually(lambda: press.press_id in self.page.answers)
        await self.page.let_go(LetGo.RELEASED, press.press_id)
        await asyncio.sleep(PAUSE_S[-1] * 2)
        self.page.answers.clear()
        self.page.ends.clear()

    async def hold(self, way: LetGo) -> None:
        """Press, hold, let go, and count what came of it."""
        loop, press = asyncio.get_running_loop(), self._press()
        await self._beat(press, random.randint(*BEATS))
        if not await self._moves(press):
            await asyncio.sleep(random.uniform(*PAUSE_S))
            return
        last_s = press.sent_s[-1]
        if way is not LetGo.CUT:
            await asyncio.sleep(random.uniform(0.0, BEAT_S / 2))
            last_s = loop.time()
        letting_go = asyncio.create_task(self.page.let_go(way, press.press_id))
        self.tally.count(way, await self.drive.until_told() - last_s)
        await letting_go
        await asyncio.sleep(random.uniform(*PAUSE_S))
        self.tally.moved_again += await self.drive.turns()
        self.page.answers.clear()
        self.page.ends.clear()
        await self.page.again()

    async def hold_until(self, way: LetGo, frozen: "Frozen") -> None:
        """Hold while a service of all is frozen; heartbeats go on, as those of a page that knows nothing."""
        press = self._press()
        await self._beat(press, BEATS[-1])
        moves = await self._moves(press)
        await frozen.by_all()
        beating = asyncio.create_task(self._beat(press, round(FROZEN_S["web"] / BEAT_S)))
        if moves:
            self.tally.count(way, await self.drive.until_told() - frozen.at_s)
        await beating
        await frozen.thawed.wait()
        await asyncio.sleep(PAUSE_S[-1] * 2)
        self.tally.moved_again += await self.drive.turns()

    def _press(self) -> Press:
        self.presses += 1
        return Press(self.product, f"press {self.presses} of {self.page.tracker_id}")

    async def _beat(self, press: Press, beats: int) -> None:
        """Say some times that the button is held."""
        loop, direction = asyncio.get_running_loop(), 1 - self.presses % 2 * 2
        due_s = loop.time()
        for _ in range(beats):
            sent_s = await self.page.beat(press.press_id, direction, len(press.sent_s))
            press.sent(sent_s)
            due_s = max(due_s, sent_s) + BEAT_S
            await asyncio.sleep(max(0.0, due_s - loop.time()))

    async def _moves(self, press: Press) -> bool:
        """Return whether the axis turns by this press; count why not."""
        looked_s = asyncio.get_running_loop().time()
        moves = await self.drive.turns()
        press.look()
        if moves:
            self.tally.held += 1
            return True
        answers = self.page.answers.get(press.press_id, [])
        if press.longest_gap_s(looked_s) > RIG_LATE_S:
            self.tally.not_held += 1
            cause = "not held"
        elif answers and answers[0].text != "ok":
            self.tally.refused += 1
            cause = "refused"
        else:
            self.tally.held += 1
            self.tally.stopped_by_itself += 1
            cause = "stopped by itself"
        self.tally.why.append(f"{cause}: {press.tell(looked_s, answers, self.page.ends)}")
        return False


class Frozen:
    """A service that is frozen once all hold their buttons, and goes on after a while."""

    def __init__(self, product: Product, child: str, holders: int) -> None:
        self.at_s = 0.0
        self.thawed = asyncio.Event()
        self._product, self._child, self._missing = product, child, holders
        self._frozen = asyncio.Event()

    async def by_all(self) -> None:
        """Return once it is frozen, which it is when the last holder comes here."""
        self._missing -= 1
        if self._missing == 0:
            self.at_s = asyncio.get_running_loop().time()
            self._product.signal(self._child, signal.SIGSTOP)
            asyncio.get_running_loop().call_later(FROZEN_S[self._child], self._thaw)
            self._frozen.set()
        await self._frozen.wait()

    def _thaw(self) -> None:
        self._product.signal(self._child, signal.SIGCONT)
        self.thawed.set()


@dataclass
class Rig:
    """The product with many trackers, each behind Modbus TCP."""

    product: Product
    ports: Sequence[int]

    async def let_go(self, ways: Sequence[LetGo]) -> Tally:
        """Hold and let go once a way, in their order, by as many hands as there are trackers."""
        waiting, tally = iter(ways), Tally()
        async with self._buttons(tally) as buttons:
            await asyncio.gather(*(_work(button, waiting) for button in buttons))
        return tally

    async def freeze(self, way: LetGo, times: int) -> Tally:
        """Freeze a service again and again while all buttons are held."""
        tally, child = Tally(), "web" if way is LetGo.PANEL_FROZEN else "controller"
        async with self._buttons(tally) as buttons:
            for _ in range(times):
                frozen = Frozen(self.product, child, len(buttons))
                await asyncio.gather(*(button.hold_until(way, frozen) for button in buttons))
                await asyncio.gather(*(asyncio.to_thread(self._until_allowed, button) for button in buttons))
        return tally

    def _until_allowed(self, button: Button) -> None:
        calling = Integrator(self.product.url, button.page.tracker_id)
        calling.until_allowed("jog")
        calling.close()

    @asynccontextmanager
    async def _buttons(self, tally: Tally) -> AsyncIterator[list[Button]]:
        pages = [Page(self.product.port, f"B{number}") for number in range(len(self.ports))]
        drives = [await Watched.at(port) for port in self.ports]
        await asyncio.gather(*(page.open() for page in pages))
        buttons = [
            Button(page, drive, tally, self.product) for page, drive in zip(pages, drives, strict=True)
        ]
        try:
            for button in buttons:
                await button.take_control()
            yield buttons
        finally:
            await asyncio.gather(*(page.close() for page in pages), return_exceptions=True)
            await asyncio.gather(*(drive.close() for drive in drives), return_exceptions=True)


async def _work(button: Button, ways: Iterator[LetGo]) -> None:
    for way in ways:
        await button.hold(way)


@contextmanager
def rig(trackers: int) -> Iterator[Rig]:
    """Start as many drives and the product with a tracker for each; this program is punctual meanwhile."""
    with tempfile.TemporaryDirectory() as folder, farm(trackers) as ports:
        product = Product.start(Path(folder) / "data")
        try:
            keep_punctual(0)
            gc.freeze()
            for number, port in enumerate(ports):
                _add(product.url, f"B{number}", port)
            yield Rig(product, ports)
        finally:
            gc.unfreeze()
            with suppress(OSError):
                os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
            product.stop()


@contextmanager
def busy(programs: int) -> Iterator[None]:
    """Keep the processors busy with other programs meanwhile."""
    spinning = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(programs)]
    try:
        yield
    finally:
        for program in spinning:
            end(program)


def _add(url: str, tracker_id: str, port: int) -> None:
    calling = Integrator(url, tracker_id)
    drive = {"kind": "modbus-tcp", "profile": "simulated-plc", "host": "127.0.0.1", "port": port}
    added = calling.http.post(
        "/api/v1/trackers", json={"tracker_id": tracker_id, "name": tracker_id, "drive": drive}
    )
    assert added.status_code == httpx.codes.CREATED, added.text
    calling.until_allowed("jog")
    calling.close()
