"""A flood of commands over MQTT: what is beyond the budget is refused, and no stop waits for any of it."""

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

import pytest

from app.base.clock import VirtualClock
from app.gateway.mqtt_client import SAY_AGAIN, quiet_logger
from app.gateway.mqtt_lanes import MOST_AT_ONCE, MOST_WAITING, CommandLanes
from app.link.messages import Order
from app.tracker.commands.commands import Stop
from tests.patience import eventually
from tests.site.plant import SUMMER_NOON


@dataclass
class Door:
    """Carries nothing out but stops, until its gate is opened."""

    gate: asyncio.Event = field(default_factory=asyncio.Event)
    orders: list[Order] = field(default_factory=list)

    async def execute(self, order: Order) -> None:
        if not isinstance(order.command, Stop):
            await self.gate.wait()
        self.orders.append(order)

    def latest(self) -> None:
        return None


@asynccontextmanager
async def lanes(door: Door) -> AsyncIterator[tuple[CommandLanes, list[Any]]]:
    answers: list[Any] = []

    async def answer(tracker_id: str, text: bytes) -> None:
        answers.append(json.loads(text))

    made = CommandLanes(door, VirtualClock(SUMMER_NOON), answer)  # type: ignore[arg-type]
    async with asyncio.TaskGroup() as tasks:
        serving = tasks.create_task(_serve(made))
        yield made, answers
        serving.cancel()


async def _serve(made: CommandLanes) -> None:
    async with asyncio.TaskGroup() as tasks:
        made.start(tasks)


def message(kind: str, key: object) -> bytes:
    return json.dumps({"type": kind, "client": "scada", "key": str(key)}).encode()


async def test_a_stop_waits_for_nothing_and_what_is_too_much_is_refused() -> None:
    door = Door()
    async with lanes(door) as (made, answers):
        for number in range(MOST_WAITING + 50):
            made.take("T1", message("track", number), retained=False)
        made.take("T1", message("stop", "stop"), retained=False)
        await eventually(lambda: answers)
        assert [order.command for order in door.orders] == [Stop()]
        assert [one["key"] for one in answers] == ["stop"]
        door.gate.set()
        await eventually(lambda: len(answers) == 1 + MOST_WAITING)
        refused = [one["reasons"][0]["code"] for one in answers if one["reasons"]]
        assert refused == ["too_many"] * (MOST_WAITING - MOST_AT_ONCE)
        assert len(door.orders) == 1 + MOST_AT_ONCE


async def test_many_stops_of_one_tracker_are_some_and_each_tracker_is_stopped() -> None:
    door = Door()
    async with lanes(door) as (made, _):
        for number in range(10 * MOST_WAITING):
            made.take("T1", message("stop", number), retained=False)
        made.take("T2", message("stop", "2"), retained=False)
        await eventually(lambda: len(door.orders) == MOST_WAITING + 1)
        await asyncio.sleep(0.05)
        assert len(door.orders) == MOST_WAITING + 1
        assert {order.tracker_id for order in door.orders} == {"T1", "T2"}


async def test_a_retained_stop_stops_and_everything_else_that_is_retained_is_refused() -> None:
    door = Door()
    async with lanes(door) as (made, answers):
        made.take("T1", message("track", "t"), retained=True)
        made.take("T1", message("stop", "s"), retained=True)
        await eventually(lambda: len(answers) == 2)
    told = {one["key"]: [reason["code"] for reason in one["reasons"]] for one in answers}
    assert told == {"t": ["retained"], "s": []}


async def test_every_command_goes_to_its_own_tracker_and_is_answered_there() -> None:
    door, told = Door(), []

    async def answer(tracker_id: str, text: bytes) -> None:
        told.append((tracker_id, json.loads(text)["key"]))

    door.gate.set()
    made = CommandLanes(door, VirtualClock(SUMMER_NOON), answer)  # type: ignore[arg-type]
    async with asyncio.TaskGroup() as tasks:
        serving = tasks.create_task(_serve(made))
        for tracker_id, kind in (("T1", "track"), ("T2", "park"), ("T3", "stop"), ("T4", "stop")):
            made.take(tracker_id, message(kind, kind + tracker_id), retained=False)
        await eventually(lambda: len(told) == 4)
        serving.cancel()
    carried_out = {(order.tracker_id, order.command.kind) for order in door.orders}
    assert carried_out == {("T1", "track"), ("T2", "park"), ("T3", "stop"), ("T4", "stop")}
    assert set(told) == {("T1", "trackT1"), ("T2", "parkT2"), ("T3", "stopT3"), ("T4", "stopT4")}


def test_the_library_warns_of_a_flood_once_a_minute(caplog: pytest.LogCaptureFixture) -> None:
    clock = VirtualClock(SUMMER_NOON)
    logger = quiet_logger(clock)
    for _ in range(3):
        logger.warning("Message queue is full. Discarding message.")
    logger.warning("Something else.")
    clock.advance(SAY_AGAIN)
    logger.warning("Message queue is full. Discarding message.")
    said = [record.getMessage() for record in caplog.records]
    full = "Message queue is full. Discarding message."
    assert said == [full, "Something else.", full]
