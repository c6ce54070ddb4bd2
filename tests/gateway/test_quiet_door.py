"""A control system that asks in cycles for what is refused: journalled once, and nothing else lost."""

from datetime import datetime, timedelta
from typing import Any

import pytest

from app.alarms.conditions import SITE, Condition
from app.gateway.quiet_door import MOST_REMEMBERED, TELL_AGAIN, QuietDoor
from app.tracker.state.snapshot import Event, EventKind
from tests.golden.table import ClockRow, clocks
from tests.site.plant import SUMMER_NOON


class Door:
    """Notes what is passed on to it."""

    def __init__(self) -> None:
        self.noted: list[tuple[Event, ...]] = []
        self.passed: list[tuple[Any, ...]] = []

    def note(self, *events: Event) -> None:
        self.noted.append(events)

    def trouble(self, name: str, condition: Condition | None) -> None:
        self.passed.append((name, condition))

    async def watch(self, tracker_ids: frozenset[str]) -> None:
        self.passed.append((tracker_ids,))


def refused(at: datetime, message: str = "T1 is locked.", tracker_id: str | None = "T1") -> Event:
    return Event(at, EventKind.REMOTE_REFUSED, tracker_id, message, "SunSpec")


def quiet() -> tuple[QuietDoor, Door]:
    door = Door()
    return QuietDoor(door), door  # type: ignore[arg-type]


def test_the_same_refusal_is_told_again_after_a_minute_of_silence() -> None:
    asked, door = quiet()
    second = timedelta(seconds=1)
    asked.note(refused(SUMMER_NOON))
    for number in range(1, 60):
        asked.note(refused(SUMMER_NOON + number * second))
    assert door.noted == [(refused(SUMMER_NOON),)]
    last = SUMMER_NOON + 59 * second
    asked.note(refused(last + TELL_AGAIN - timedelta(microseconds=1)))
    assert len(door.noted) == 1
    again = refused(last + 2 * TELL_AGAIN - timedelta(microseconds=1))
    asked.note(again)
    assert door.noted[1:] == [(again,)]


def test_other_refusals_and_everything_that_is_none_are_told_at_once() -> None:
    asked, door = quiet()
    moved = Event(SUMMER_NOON, EventKind.REMOTE_WRITTEN, "T1", "SunSpec moves T1.", "SunSpec")
    told = (
        refused(SUMMER_NOON),
        refused(SUMMER_NOON, "T1 is on local."),
        refused(SUMMER_NOON, tracker_id="T2"),
        moved,
        moved,
    )
    asked.note(*told, refused(SUMMER_NOON))
    assert door.noted == [told]


def test_of_very_many_refusals_the_one_that_came_longest_ago_is_forgotten() -> None:
    asked, door = quiet()
    all_of_them = [refused(SUMMER_NOON, f"No. {number}") for number in range(MOST_REMEMBERED)]
    asked.note(*all_of_them)
    asked.note(all_of_them[0])
    assert len(door.noted) == 1, "all are remembered"
    asked.note(refused(SUMMER_NOON, "one more"))
    asked.note(all_of_them[0])
    asked.note(all_of_them[2])
    assert len(door.noted) == 2
    asked.note(all_of_them[1])
    assert door.noted[2:] == [(all_of_them[1],)], "it came longest ago"


async def test_troubles_and_what_is_watched_are_passed_on() -> None:
    asked, door = quiet()
    condition = Condition("gateway_down", None, SITE, "no broker")
    asked.trouble("SunSpec", condition)
    asked.trouble("SunSpec", None)
    await asked.watch(frozenset({"T1"}))
    assert door.passed == [("SunSpec", condition), ("SunSpec", None), (frozenset({"T1"}),)]


@pytest.mark.parametrize("row", clocks("told_again"))
def test_a_refusal_is_told_although_the_site_clock_was_set(row: ClockRow) -> None:
    asked, door = quiet()
    asked.note(refused(SUMMER_NOON + row.stored))
    asked.note(refused(SUMMER_NOON + row.asked + row.later))
    assert {1: "quiet", 2: "told"}[len(door.noted)] == row.expected
