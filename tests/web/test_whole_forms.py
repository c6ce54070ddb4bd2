"""A form that lacks fields changes nothing of them: it is refused, or what it lacks stays as it is stored."""

import re
from collections.abc import AsyncIterator, Mapping
from dataclasses import replace

import httpx
import pytest

from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind
from app.tracker.settings.mechanics import Corner, Region
from app.tracker.settings.mechanisms import MECHANISMS
from app.web.features.setup.machine_forms import texts
from app.web.http.whole_forms import INCOMPLETE
from tests.amount import amount
from tests.fake_store import FakeReader
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import FaultResult
from tests.web.filled import filled, values_of

T1 = "/trackers/T1"
PAGES = (
    "/", "/site", "/site/horizon", "/site/notifications", "/network", "/users", "/tokens", "/simulate",
    "/studies", f"{T1}/commissioning/location", f"{T1}/commissioning/clock",
    f"{T1}/commissioning/clock/shadow", f"{T1}/commissioning/mode",
    f"{T1}/drive", f"{T1}/settings", f"{T1}/strategy", f"{T1}/protections", f"{T1}/machine", f"{T1}/service",
    f"{T1}/record", T1, f"{T1}/drive-tests", f"{T1}/sun-check", f"{T1}/mount",
)  # fmt: skip
KINDS = list(MountKind)[:: amount(3, 1)]
ORDER_FIELDS = frozenset({"back", "issued_at", "key", "epoch", "page"})
"""What says of an order when and where it was given; it is no part of what is ordered."""
ASKED_AT_TIMES = frozenset({"device_zone", "at", "reason", "table", "example", "mode"})
"""What a page asks at times only, or fills from: without it, nothing of it is changed."""
UNREAD = frozenset(f"{T1}/{page}" for page in ("settings", "protections", "machine", "mount"))
"""Forms of which some fields are not read, such as the points of an actuator that is not there."""
WALL = Region("Wall", (Corner(170.0, 0.0), Corner(190.0, 0.0), Corner(190.0, 30.0)))


@pytest.fixture
async def client(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine, FakeReader())) as browser:
        yield browser


def stored(machine: FakeMachine) -> object:
    return machine.site, {name: one.config for name, one in machine.trackers.items()}


def is_incomplete(answer: httpx.Response) -> bool:
    return answer.status_code == 422 and INCOMPLETE in answer.text


async def trouble_of(client: httpx.AsyncClient, machine: FakeMachine, page: str, action: str) -> list[str]:
    """Return each field of a form whose lack is taken for an empty field."""
    form = values_of((await client.get(page)).text, action)
    found = []
    for name in sorted(form.keys() - ORDER_FIELDS - ASKED_AT_TIMES)[:: amount(3, 1)]:
        before = stored(machine)
        answer = await client.post(action, data={key: value for key, value in form.items() if key != name})
        stays = action in UNREAD and stored(machine) == before
        if not is_incomplete(answer) and not stays:
            found.append(f"{action} without {name}: {answer.status_code}")
    return found


def actions_of(page: str) -> set[str]:
    """Return where the forms of a page send what, but the frame's and those that end something."""
    found = re.findall(r'<form[^>]*method="post"[^>]* action="([^"?]+)"', page)
    return {
        one for one in found if not re.search(r"^/(theme|language|logout)$|/(stop|remove|end|undo)$", one)
    }


@pytest.mark.parametrize("page", PAGES)
async def test_no_form_is_taken_without_one_of_its_fields(
    client: httpx.AsyncClient, machine: FakeMachine, page: str
) -> None:
    actions = actions_of((await client.get(page)).text)
    assert actions
    assert [
        line for action in sorted(actions) for line in await trouble_of(client, machine, page, action)
    ] == []


SETTINGS = (f"{T1}/settings", f"{T1}/protections", f"{T1}/machine", f"{T1}/mount", "/site/notifications")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("page", SETTINGS)
async def test_what_a_page_shows_is_what_it_saves(
    client: httpx.AsyncClient, machine: FakeMachine, page: str, kind: MountKind
) -> None:
    tracker = machine.trackers["T1"]
    tracker.config = mounted(tracker.config, kind, 41.0)
    tracker.config = replace(tracker.config, machine=replace(tracker.config.machine, regions=(WALL,)))
    before = stored(machine)
    assert (await client.post(page, data=await filled(client, page))).status_code == 303
    assert stored(machine) == before


async def test_what_a_mount_does_not_show_stays_as_it_is_stored(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    tracker = machine.trackers["T1"]
    config = mounted(tracker.config, MountKind.VERTICAL_SINGLE_AXIS, 41.0)
    hidden = replace(config.mount, least_incidence=True)
    actuator = MECHANISMS["alexandru-elevation"]()
    slow = {"speed_dps": 0.1, "jog_slow_dps": 0.05, "jog_fast_dps": 0.1}
    second = replace(config.elevation, minimum_deg=-20.0, maximum_deg=20.0, actuator=actuator, **slow)
    tracker.config = replace(config, mount=hidden, elevation=second)
    before = stored(machine)
    assert (await client.post(f"{T1}/mount", data=await filled(client, f"{T1}/mount"))).status_code == 303
    assert stored(machine) == before


@pytest.mark.fault(99)
@pytest.mark.parametrize("htmx", [{}, {"HX-Request": "true", "HX-Request-Type": "partial"}])
async def test_mechanics_without_the_part_of_the_regions_keep_them(
    client: httpx.AsyncClient, machine: FakeMachine, htmx: Mapping[str, str], fault: FaultResult
) -> None:
    tracker = machine.trackers["T1"]
    tracker.config = replace(tracker.config, machine=replace(tracker.config.machine, regions=(WALL,)))
    form = {
        name: text for name, text in texts(tracker.config.machine).items() if not name.startswith("region")
    }
    assert is_incomplete(await client.post(f"{T1}/machine", data=form, headers=htmx))
    assert is_incomplete(await client.post(f"{T1}/machine/picture", data=form, headers=htmx))
    assert tracker.config.machine.regions == (WALL,)
    assert not machine.orders
    fault.prevented("refused unless every field came")
    fault.shows(INCOMPLETE)
    fault.recovers("the page is loaded again")


async def test_a_token_is_not_made_for_every_tracker_because_their_field_is_missing(
    client: httpx.AsyncClient,
) -> None:
    form = await filled(client, "/tokens", {"name": "scada"})
    del form["trackers"]
    assert is_incomplete(await client.post("/tokens", data=form))


async def test_an_emptied_number_is_not_the_usual_one(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    before = stored(machine)
    page = f"{T1}/strategy"
    for action, typed in (
        (page, {"kind": "interval", "minutes": ""}),
        (f"{page}/hybrid", {"cloud": ""}),
        ("/site/weather-station", {"host": "10.0.0.5", "port": ""}),
    ):
        where = page if action.startswith(page) else "/site"
        answer = await client.post(action, data=await filled(client, where, typed, action=action))
        assert answer.status_code == 422
        assert "type a number" in answer.text
    assert stored(machine) == before
