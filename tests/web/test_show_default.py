"""The page of a show opens with one that can be run, wherever and whenever, or says what can be done."""

import re
from dataclasses import replace
from datetime import date, datetime, timedelta
from html import unescape
from urllib.parse import parse_qs

import pytest

from app.base.clock import VirtualClock
from app.sun.position import Location
from app.tracker.commands.commands import GoToStart
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind
from tests.fakes import FakeMachine, fake_app, serving

SHOW = "/trackers/T1/show"
SYDNEY = (Location(-33.87, 151.21), "Australia/Sydney")
TROMSO = (Location(69.65, 18.96), "Europe/Oslo")


def machine_at(where: tuple[Location, str], *, at: str = "2026-11-22T03:00:00+00:00") -> FakeMachine:
    machine = FakeMachine(VirtualClock(datetime.fromisoformat(at)))
    location, zone = where
    machine.site = replace(machine.site, location=location, time_zone=zone)
    machine.emit()
    return machine


async def opened(machine: FakeMachine, path: str = SHOW) -> str:
    async with serving(fake_app(machine)) as client:
        answer = await client.get(path)
        assert answer.status_code == 200
        return answer.text


def typed(text: str) -> dict[str, str]:
    """Return what stands in the fields of the form."""
    return dict(re.findall(r'<input class="input"[^>]* name="(\w+)"[^>]* value="([^"]*)"', text))


def instead(text: str) -> tuple[str, str]:
    """Return where the key goes that is offered instead, and what it says."""
    found = re.search(r'<a class="key key-main key-wide key-primary" href="([^"]*)">([^<]*)</a>', text)
    assert found
    return unescape(found[1]), found[2]


async def test_in_the_south_it_opens_with_what_works_and_says_why_it_takes_longer() -> None:
    machine = machine_at(SYDNEY)
    text = await opened(machine)
    assert typed(text) == {"date": "2026-11-22", "start": "05:40", "end": "19:42", "minutes": "5"}
    assert "This works: 5 min" in text
    assert "3 minutes are too short here: the panel must turn back at north." in text
    async with serving(fake_app(machine)) as client:
        await client.post(f"{SHOW}/go-to-start", data=typed(text))
    (order,) = [one.command for one in machine.orders if isinstance(one.command, GoToStart)]
    assert order.plan.duration == timedelta(minutes=5)


async def test_what_was_typed_is_judged_as_it_was_typed() -> None:
    machine = machine_at(SYDNEY)
    text = await opened(machine, f"{SHOW}?date=2026-11-22&start=05:40&end=19:42&minutes=3")
    assert "This show cannot be run." in text
    assert instead(text)[1] == "Use 4 min instead"
    assert "Minutes: type a number" in await opened(machine, f"{SHOW}?date=2026-11-22&minutes=")


@pytest.mark.parametrize("where", [SYDNEY, TROMSO], ids=["Sydney", "Tromsø"])
async def test_every_preset_opens_with_a_show_that_works_or_with_one_that_does(
    where: tuple[Location, str],
) -> None:
    machine = machine_at(where)
    text = await opened(machine)
    links = re.findall(r'<a class="key" href="(\?[^"]*)"', text)
    assert len(links) >= 3
    for link in links:
        page = await opened(machine, SHOW + unescape(link))
        if "This works" not in page:
            page = await opened(machine, SHOW + instead(page)[0])
        assert "This works" in page


async def test_a_mode_that_the_mount_does_not_have_leads_to_those_that_it_has() -> None:
    machine = machine_at(SYDNEY)
    tracker = machine.trackers["T1"]
    tracker.config = mounted(tracker.config, MountKind.HORIZONTAL_SINGLE_AXIS, -33.87)
    text = await opened(machine)
    assert "does not support the mode dual" in text
    assert instead(text) == ("/trackers/T1/commissioning/mode", "Choose another mode")


async def test_in_the_polar_night_it_says_so_and_proposes_a_day_with_sun() -> None:
    machine = machine_at(TROMSO, at="2026-12-05T10:00:00+00:00")
    text = await opened(machine)
    assert "It is polar night: on this day the sun does not rise here." in text
    link, label = instead(text)
    day = date.fromisoformat(parse_qs(link[1:])["date"][0])
    assert date(2027, 1, 12) < day < date(2027, 1, 22)
    assert label == f"Use {day}, the next day with an hour of sun"
    assert "This works: 3 min" in await opened(machine, SHOW + link)
