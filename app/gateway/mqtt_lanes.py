"""Commands over MQTT in two lanes: a stop is carried out at once, the others one after the other."""

import asyncio
from collections.abc import Awaitable, Callable

from app.base.budget import Budget
from app.base.clock import Clock
from app.gateway.mqtt_commands import RETAINED, TOO_MANY, is_stop, obey
from app.gateway.ports import Door
from app.tracker.values.reason import Reason

COMMANDS_PER_S, MOST_AT_ONCE = 20.0, 50
MOST_WAITING = 100

Answer = Callable[[str, bytes], Awaitable[None]]
"""Tells the sender of a tracker's command what came of it."""


class CommandLanes:
    """Takes every command without waiting; beyond the budget, and beyond what may wait, they are refused."""

    def __init__(self, door: Door, clock: Clock, answer: Answer) -> None:
        self._door = door
        self._answer = answer
        self._budget = Budget(clock, per_s=COMMANDS_PER_S, burst=MOST_AT_ONCE)
        self._waiting: asyncio.Queue[tuple[str, bytes, tuple[Reason, ...]]] = asyncio.Queue(MOST_WAITING)
        self._answers: asyncio.Queue[tuple[str, bytes]] = asyncio.Queue(MOST_WAITING)
        self._stops: dict[tuple[str, bytes], None] = {}
        self._stop_came = asyncio.Event()

    def start(self, tasks: asyncio.TaskGroup) -> None:
        """Begin to carry out what comes."""
        for work in (self._carry_out(), self._stop(), self._tell()):
            tasks.create_task(work)

    def take(self, tracker_id: str, payload: bytes, *, retained: bool) -> None:
        """Put one command into its lane; of many stops of one tracker that wait, some are enough."""
        if is_stop(payload):
            if len(self._stops) < MOST_WAITING or all(waits != tracker_id for waits, _ in self._stops):
                self._stops[tracker_id, payload] = None
            self._stop_came.set()
        elif not self._waiting.full():
            allowed = self._budget.spend()
            against = (RETAINED,) if retained else () if allowed else (TOO_MANY,)
            self._waiting.put_nowait((tracker_id, payload, against))

    async def _carry_out(self) -> None:
        while True:
            tracker_id, payload, against = await self._waiting.get()
            told = await obey(self._door, tracker_id, payload, against=against)
            await self._answers.put((tracker_id, told))

    async def _stop(self) -> None:
        """Carry out all stops that wait side by side; none of them waits until an answer was told."""
        while True:
            await self._stop_came.wait()
            self._stop_came.clear()
            stops, self._stops = self._stops, {}
            told = await asyncio.gather(*(obey(self._door, *stop) for stop in stops))
            for (tracker_id, _), answer in zip(stops, told, strict=True):
                if not self._answers.full():
                    self._answers.put_nowait((tracker_id, answer))

    async def _tell(self) -> None:
        while True:
            await self._answer(*await self._answers.get())
