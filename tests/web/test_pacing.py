"""Many pages at once hold up nobody: streams begin one by one, and a slow hand-out leaves time to others."""

import asyncio
from datetime import datetime, timedelta
from itertools import pairwise
from typing import Any

import pytest

from app.base.clock import SystemClock, VirtualClock
from app.link.messages import Update
from app.web.http.limits import StreamLimit
from app.web.live.hub import BATCH, SOONEST, Hub
from app.web.live.viewers import Wanted
from tests.captured_logs import capture_logs
from tests.fake_data import NOON
from tests.fakes import FakeMachine
from tests.site.plant import settle

A_BATCH_TAKES = timedelta(milliseconds=40)


class SluggishClock(VirtualClock):
    """A clock on which every hand-out to one batch of viewers takes a while."""

    async def sleep_until(self, at: datetime) -> None:
        if at <= self.now():
            self.advance(A_BATCH_TAKES)
        await super().sleep_until(at)


async def test_of_many_streams_that_come_at_once_each_lets_others_pass() -> None:
    began: list[str] = []

    async def answer(scope: Any, receive: Any, send: Any) -> None:
        began.append(scope["path"])

    async def nothing(message: Any = None) -> None:
        """Hear and tell nothing."""

    limit = StreamLimit(answer, clock=SystemClock())
    paths = ["/live"] * 50 + ["/stop"]
    scopes = [{"type": "http", "path": path, "client": ("127.0.0.1", 1)} for path in paths]
    await asyncio.gather(*(limit(scope, nothing, nothing) for scope in scopes))
    assert len(began) == 51
    assert began.index("/stop") <= 1


async def test_a_hand_out_that_takes_long_is_followed_by_as_long_a_rest() -> None:
    clock = SluggishClock(NOON)
    machine = FakeMachine(clock)
    hub = Hub(machine, clock)
    viewers = [hub.join(Wanted()) for _ in range(10 * BATCH)]
    last, shown_at = viewers[-1], []
    running = asyncio.create_task(hub.run())
    while clock.now() < NOON + timedelta(seconds=6):
        last._state = None
        machine.emit()
        clock.advance(timedelta(milliseconds=10))
        for _ in range(30):
            await asyncio.sleep(0)
        if last._state is not None:
            shown_at.append(clock.now())
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    pauses = [later - earlier for earlier, later in pairwise(shown_at)]
    assert len(pauses) >= 4
    assert min(pauses) >= 2 * 10 * A_BATCH_TAKES > 10 * A_BATCH_TAKES + SOONEST


async def test_a_mistake_with_an_update_shows_no_stale_values_and_the_next_ones_are_heard(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = VirtualClock(NOON)
    machine = FakeMachine(clock)
    hub = Hub(machine, clock)
    hear, mistakes = hub._hear, list[Exception]()

    def hear_or_fail(update: Update) -> None:
        if mistakes:
            raise mistakes.pop()
        hear(update)

    monkeypatch.setattr(hub, "_hear", hear_or_fail)
    running = asyncio.create_task(hub.run())
    with capture_logs() as logs:
        machine.emit()
        await settle()
        (told,) = await hub.join(Wanted()).take()
        assert told.name == "snapshot"
        mistakes.append(KeyError("unforeseen"))
        machine.emit()
        await settle()
        (told,) = await hub.join(Wanted()).take()
        assert told.name == "machine_lost"
        clock.advance(timedelta(seconds=1))
        await settle()
        machine.emit()
        await settle()
    (told,) = await hub.join(Wanted()).take()
    assert told.name == "snapshot"
    assert [line["event"] for line in logs] == ["task_broke"]
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
