"""The page of a show opens with one that can be run, wherever and whenever, or says what can be done."""

import re
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from html import unescape
from urllib.parse import parse_qs

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.clock import VirtualClock
from app.link.messages import TrackerDetail
from app.sun.position import Location
from app.tracker.commands.commands import GoToStart
from app.tracker.mounts.capabilities import abilities
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind
from app.tracker.values.mode import Mode
from app.web.features.shows.show_plan import Place, ShowForm, planned, presets
from app.web.shell.forms import Typed
from tests.amount import amount
from tests.fake_data import commissioned
from tests.fakes import FakeMachine, fake_app, serving

SHOW = "/trackers/T1/show"
SYDNEY = (Location(-33.87, 151.21), "Australia/Sydney")
TROMSO = (Location(69.65, 18.96), "Europe/Oslo")
CAPE = (Location(-33.92, 18.42), "Africa/Johannesburg")
T1 = commissioned("T1", "North field", tracking=False)


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


async def test_in_the_north_it_opens_with_three_minutes_and_says_nothing_of_it() -> None:
    text = await opened(FakeMachine(VirtualClock(datetime(2026, 6, 21, 9, tzinfo=UTC))))
    assert typed(text) == {"date": "2026-06-21", "start": "05:02", "end": "20:11", "minutes": "3"}
    assert "This works: 3 min" in text
    assert "too fast" not in text


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


@pytest.mark.parametrize("where", [SYDNEY, CAPE, TROMSO], ids=["Sydney", "the Cape", "Tromsø"])
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


async def test_a_preset_is_marked_on_its_day_from_sunrise_to_sunset_only() -> None:
    machine = machine_at(SYDNEY)
    assert 'aria-current="true"><span>21 June' in await opened(machine, f"{SHOW}?date=2026-06-21")
    shorter = await opened(machine, f"{SHOW}?date=2026-06-21&start=08:00&end=12:00&minutes=3")
    assert 'aria-current="true"><span>21 June' not in shorter


@pytest.mark.parametrize("kind", MountKind)
async def test_a_mount_without_a_chosen_mode_opens_with_one_that_it_has(kind: MountKind) -> None:
    machine = machine_at(SYDNEY)
    tracker = machine.trackers["T1"]
    tracker.config = mounted(tracker.config, kind, -33.87)
    tracker.memory = replace(tracker.memory, mode=None)
    assert "This works" in await opened(machine)


async def test_a_mode_that_the_mount_does_not_have_leads_to_those_that_it_has() -> None:
    machine = machine_at(SYDNEY)
    tracker = machine.trackers["T1"]
    tracker.config = mounted(tracker.config, MountKind.HORIZONTAL_SINGLE_AXIS, -33.87)
    text = await opened(machine)
    assert "does not support the mode dual" in text
    assert instead(text) == ("/trackers/T1/commissioning/mode", "Choose another mode")


async def test_a_fixed_panel_is_said_to_stand_still() -> None:
    machine = machine_at(SYDNEY)
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, mode=Mode.FIXED)
    assert "the panel does not move during the show" in await opened(machine)


async def test_in_the_polar_night_it_says_so_and_proposes_a_day_with_sun() -> None:
    machine = machine_at(TROMSO, at="2026-12-05T10:00:00+00:00")
    text = await opened(machine)
    assert "It is polar night: on this day the sun does not rise here." in text
    link, label = instead(text)
    day = date.fromisoformat(parse_qs(link[1:])["date"][0])
    assert date(2027, 1, 12) < day < date(2027, 1, 22)
    assert label == f"Use {day}, the next day with an hour of sun"
    assert "This works: 3 min" in await opened(machine, SHOW + link)


async def test_in_the_polar_day_the_whole_day_is_shown() -> None:
    text = await opened(machine_at(TROMSO, at="2026-06-21T10:00:00+00:00"))
    assert {"start": "00:00", "end": "00:00"}.items() <= typed(text).items()
    assert "This works" in text


async def test_hours_of_the_night_are_answered_with_those_of_the_day() -> None:
    text = await opened(machine_at(SYDNEY), f"{SHOW}?date=2026-11-22&start=21:00&end=02:00&minutes=3")
    assert "The sun is below the horizon" in text
    assert instead(text) == ("?date=2026-11-22", "Use sunrise to sunset instead: 05:40 to 19:42")


async def test_where_clocks_are_far_from_the_sun_the_daylight_is_still_whole() -> None:
    text = await opened(machine_at((SYDNEY[0], "UTC")))
    assert {"start": "18:40", "end": "08:43"}.items() <= typed(text).items()
    assert "This works: 5 min" in text


async def test_a_day_outside_the_known_years_is_refused_in_a_sentence() -> None:
    for day in ("1850-06-21", "2120-06-21", "0001-01-01", "9999-12-31"):
        text = await opened(machine_at(SYDNEY), f"{SHOW}?date={day}")
        assert "choose a day in the years 1901 to 2099." in text


@settings(max_examples=amount(15, 60), deadline=None)
@given(
    latitude_deg=st.floats(-66.0, 66.0),
    longitude_deg=st.floats(-180.0, 180.0),
    day=st.dates(date(1902, 1, 1), date(2098, 12, 31)),
    zone=st.sampled_from(("UTC", "Australia/Sydney", "America/Santiago", "Europe/Istanbul", "Asia/Kolkata")),
    kind=st.sampled_from((None, *MountKind)),
    mode=st.sampled_from((None, *Mode)),
)
def test_anywhere_on_any_day_the_opened_show_can_be_run(
    latitude_deg: float, longitude_deg: float, day: date, zone: str, kind: MountKind | None, mode: Mode | None
) -> None:
    config = T1.config if kind is None else mounted(T1.config, kind, latitude_deg)
    chosen = mode if mode in abilities(config.mount).modes else None
    state = replace(T1, config=config, memory=replace(T1.memory, mode=chosen))
    place = Place(TrackerDetail(state, (), None), Location(latitude_deg, longitude_deg), zone, day)
    found = planned(ShowForm(), place)
    assert found.verdict is not None
    assert found.verdict.feasible, (found.typed.texts, found.verdict.reasons)
    assert planned(ShowForm(**found.typed.texts), place).verdict == replace(found.verdict, longer=None)
    assert presets(place, found.typed)[0].current
    assert not presets(place, Typed(found.typed.texts | {"start": "00:01"}))[0].current
