"""Numbers as keyboards, phones, and word processors write them: taken as they are meant, or refused."""

import re
from collections.abc import Callable
from dataclasses import replace
from html import unescape
from typing import Any

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.base.adapter import adapter
from app.sun.position import Location
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import AxisDrive, MountKind, Rows, TrackerConfig
from app.tracker.settings.declared import declared
from app.tracker.settings.mechanics import Corner, Region
from app.tracker.settings.mechanisms import alexandru_elevation
from app.tracker.settings.strategy import Stepped
from app.tracker.values.typed_numbers import written
from app.web.shell.forms import Unreadable, number
from app.web.shell.setting_forms import put
from tests.amount import amount
from tests.fakes import FakeMachine, fake_app, serving
from tests.golden.table import rows
from tests.web.filled import filled
from tests.web.forms import every_form
from tests.web.test_forms import send

NUMBERS = rows("world/numbers.csv")
CORNERS = rows("world/corners.csv")
T1 = "/trackers/T1"
STRATEGY = f"{T1}/strategy"
Read = Callable[[TrackerConfig], float]
FIELDS: dict[str, tuple[str, str, Read]] = {
    "azimuth_off": (STRATEGY, f"{STRATEGY}/hybrid", lambda one: one.hybrid.simulated.azimuth_deg),
    "slope": (
        f"{T1}/mount",
        f"{T1}/mount",
        lambda one: one.mount.rows.cross_axis_tilt_deg if one.mount.rows else 0.0,
    ),
    "azimuth_minimum_deg": (f"{T1}/settings", f"{T1}/settings", lambda one: one.azimuth.minimum_deg),
}
"""A field of each reader of a form: its page, its form, and where its number is stored."""


def config(machine: FakeMachine) -> TrackerConfig:
    found = machine.trackers["T1"].config
    assert isinstance(found, TrackerConfig)
    return found


def ids(table: list[dict[str, str]]) -> list[str]:
    return [row["why"] for row in table]


EACH = [
    pytest.param(name, row, id=f"{name} {row['why']}")
    for place, name in enumerate(FIELDS)
    for row in NUMBERS[:: amount(4 if place else 1, 1)]
]


@pytest.mark.parametrize(("name", "row"), EACH)
async def test_a_number_is_taken_or_refused_in_its_field(
    row: dict[str, str], name: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page, action, read = FIELDS[name]
    if name == "slope":
        machine.trackers["T1"].config = mounted(config(machine), MountKind.HORIZONTAL_SINGLE_AXIS, 41.0)
    if name == "azimuth_minimum_deg":
        wide = replace(config(machine).azimuth, minimum_deg=-100.0)
        machine.trackers["T1"].config = replace(config(machine), azimuth=wide)
    before = config(machine)
    typed = {name: row["text"]} | ({"rows": "yes"} if name == "slope" else {})
    answer = await client.post(action, data=await filled(client, page, typed, action=action))
    if row["stored"] == "refused":
        assert answer.status_code == 422
        assert f'id="{name}-error"' in answer.text, "beside the field"
        assert f'value="{row["text"]}"' in unescape(answer.text), "what was typed stays"
        assert config(machine) == before
    else:
        assert answer.status_code < 400, answer.text
        assert read(config(machine)) == float(row["stored"])


THOUSANDS: dict[str, tuple[str, float, float, Callable[[FakeMachine], float]]] = {
    "altitude": (f"{T1}/commissioning/location", -500, 9000, lambda of: location(of).altitude_m),
    "azimuth_gear": (f"{T1}/drive", 1e-4, 999_999, lambda of: config(of).drive.azimuth.gear_ratio),
}
"""A field of each reader whose range reaches a thousand: its page, range, and where its number is stored."""


def location(machine: FakeMachine) -> Location:
    assert machine.site.location is not None
    return machine.site.location


@pytest.mark.parametrize(
    ("name", "row"),
    [
        pytest.param(name, row, id=f"{name} {row['why']}")
        for place, name in enumerate(THOUSANDS)
        for row in NUMBERS[:: amount(3 if place else 1, 1)]
        if row["text"].strip() and not (place and row["text"].upper().endswith("M"))
    ],
)
async def test_thousands_are_read_or_asked_for(
    row: dict[str, str], name: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page, least, most, read = THOUSANDS[name]
    before = read(machine)
    answer = await client.post(page, data=await filled(client, page, {name: row["text"]}))
    means = None if row["thousands"] in ("refused", "asked") else float(row["thousands"])
    if means is not None and least <= means <= most:
        assert answer.status_code == 303, answer.text
        assert read(machine) == means
        return
    assert answer.status_code == 422
    assert f'id="{name}-error"' in answer.text, "beside the field"
    assert ("can be read in two ways" in answer.text) == (row["thousands"] == "asked")
    assert read(machine) == before


@pytest.mark.parametrize(
    ("language", "text", "sentence"),
    [
        ("en", "1,200", "Altitude: 1,200 can be read in two ways. Type 1200 or 1.2."),
        ("en", "1.125", "Altitude: 1.125 can be read in two ways. Type 1125 or 1.1250."),
        ("en", "-1,000", "Altitude: -1,000 can be read in two ways. Type -1000 or -1."),
        ("en", "1200 ft", "Altitude: type the number alone, without a unit."),
        ("en", "12 34", "Altitude: type a number, such as -500."),
        ("de", "1.200", "1200"),
    ],
)
async def test_the_sentence_says_what_to_type(
    client: httpx.AsyncClient, language: str, text: str, sentence: str
) -> None:
    page = f"{T1}/commissioning/location"
    form = await filled(client, page, {"altitude": text})
    answer = await client.post(page, data=form, headers={"Accept-Language": language})
    assert sentence in unescape(answer.text)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("5,020", "Port must be a whole number."),
        ("5.000", "Port: 5.000 can be read in two ways. Type 5000 or 5."),
        ("5.020,5", "Port must be a whole number."),
    ],
)
async def test_a_whole_number_is_never_guessed(client: httpx.AsyncClient, text: str, sentence: str) -> None:
    form = await filled(client, f"{T1}/drive", {"kind": "modbus-tcp", "host": "127.0.0.1", "port": text})
    answer = await client.post(f"{T1}/drive", data=form)
    assert answer.status_code == 422
    assert sentence in unescape(answer.text)


@pytest.mark.parametrize("text", ["5020", "5'020", "5 020", "5\u00a0020", "5020,0"])
async def test_a_whole_number_with_thousands_apart_is_read(
    machine: FakeMachine, client: httpx.AsyncClient, text: str
) -> None:
    form = await filled(client, f"{T1}/drive", {"kind": "modbus-tcp", "host": "127.0.0.1", "port": text})
    assert (await client.post(f"{T1}/drive", data=form)).status_code == 303
    assert config(machine).drive.port == 5020


def awkward(found: TrackerConfig) -> TrackerConfig:
    """Return a configuration in which each number that may be a thousand has three decimals."""
    document: dict[str, Any] = adapter(TrackerConfig).dump_python(found)
    for path, one in declared(TrackerConfig).items():
        if one.kind is float and one.most >= 1000 and one.of(found) is not None:
            put(document, path, one.of(found) // 1 + 0.125)
    taken = adapter(TrackerConfig).validate_python(document)
    odd = AxisDrive(None, 200.125, 1.125)
    wall = Region("Wall", (Corner(170.12345, 1e-5), Corner(190.12345, 0.0), Corner(190.0, 30.0)))
    turned = replace(
        taken.elevation,
        minimum_deg=0.0,
        maximum_deg=20.0,
        speed_dps=0.1,
        jog_slow_dps=0.1,
        jog_fast_dps=0.1,
        actuator=replace(alexandru_elevation(), speed_mm_s=7.125),
    )
    return replace(
        taken,
        drive=replace(taken.drive, azimuth=odd, elevation=odd),
        elevation=turned,
        park=replace(taken.park, elevation_deg=10.0),
        hybrid=replace(taken.hybrid, threshold_wm2=150.125, decay_s=60.125),
        machine=replace(taken.machine, regions=(wall,)),
    )


NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d*)?")


@pytest.mark.parametrize("language", amount(("de",), ("de", "en", "es", "ro", "tr", "zh-Hans")))
async def test_what_a_page_writes_into_its_fields_is_taken(machine: FakeMachine, language: str) -> None:
    machine.trackers["T1"].config = awkward(config(machine))
    machine.site = replace(machine.site, location=replace(location(machine), altitude_m=4.125))
    sent = 0
    async with serving(fake_app(machine)) as client:
        client.headers["Accept-Language"] = language
        for form in await every_form(client):
            numbers = [name for name, text in form.values.items() if NUMBER.fullmatch(text)]
            if numbers:
                sent += len(numbers)
                answer = await send(client, form, form.values)
                wrong = [name for name in numbers if f'id="{name}-error"' in answer.text]
                assert not wrong, (form.action, {name: form.values[name] for name in wrong})
    assert sent > 300


@pytest.mark.parametrize("page", ["settings", "drive", "mount", "protections", "machine"])
async def test_numbers_are_stored_again_as_they_were(
    machine: FakeMachine, client: httpx.AsyncClient, page: str
) -> None:
    machine.trackers["T1"].config = before = awkward(config(machine))
    form = await filled(client, f"{T1}/{page}")
    answer = await client.post(f"{T1}/{page}", data=form)
    assert answer.status_code == 303, answer.text
    assert await filled(client, f"{T1}/{page}") == form
    assert replace(config(machine), elevation=before.elevation) == before


async def test_a_mount_is_stored_again_as_it_was(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    turned = mounted(config(machine), MountKind.TILTED_SINGLE_AXIS, 45.0)
    mount = replace(
        turned.mount, axis_azimuth_deg=123.4567, axis_tilt_deg=12.34567, rows=Rows(0.4123456, 1e-5)
    )
    machine.trackers["T1"].config = replace(turned, mount=mount)
    answer = await client.post(f"{T1}/mount", data=await filled(client, f"{T1}/mount"))
    assert answer.status_code == 303, unescape(answer.text)
    assert config(machine).mount == mount


@given(st.integers(-999_999, 999_999).map(lambda found: found / 1000), st.sampled_from([999, 1000, 1e9]))
def test_a_number_is_read_as_it_is_written(value: float, most: float) -> None:
    shown = written(value, most)
    assert "e" not in shown
    assert number(shown, "Length", -1e6, max(value + 1, most)) == pytest.approx(value, rel=1e-9, abs=0)


@pytest.mark.parametrize("row", CORNERS, ids=ids(CORNERS))
async def test_corners_are_taken_or_refused_in_their_field(
    row: dict[str, str], machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page = f"{T1}/machine"
    form = await filled(client, page, {"region0_name": "Wall", "region0_corners": row["text"]})
    preview = await client.post(f"{page}/picture", data=form)
    answer = await client.post(page, data=form)
    assert preview.status_code == 200, "the picture shows the regions that can be read"
    if row["stored"] == "refused":
        assert answer.status_code == 422
        assert 'id="region0_corners-error"' in preview.text
        assert 'id="region0_corners-error"' in answer.text
        assert not machine.orders
        return
    assert answer.status_code == 303
    assert f'value="{row["stored"]}"' in (await client.get(page)).text


@pytest.mark.parametrize("row", [row for row in NUMBERS if "U+" in row["why"]], ids=lambda row: row["why"])
async def test_a_step_program_reads_the_same_signs(
    row: dict[str, str], machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    action = f"{STRATEGY}/program"
    head = {"base": "clock", "offset": row["text"], "angles": "equator"}
    steps = {"at": ["06:00", "12:00"], "first": [row["text"], "2"], "second": ["1", row["text"]]}
    answer = await client.post(action, data=await filled(client, STRATEGY, head | steps, action=action))
    if row["stored"] == "refused":
        assert answer.status_code == 422
        return
    assert answer.status_code == 303, answer.text
    strategy = config(machine).strategy
    assert isinstance(strategy, Stepped)
    assert strategy.program.utc_offset_h == strategy.program.steps[0].first_deg == float(row["stored"])


async def test_a_step_program_reads_decimal_commas(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    action = f"{STRATEGY}/program"
    steps: dict[str, str | list[str]] = {
        "at": ["8,5", "12:00"],
        "first": ["100,5°", "110"],
        "second": ["30,25", "−2,5"],
    }
    answer = await client.post(action, data=await filled(client, STRATEGY, steps, action=action))
    assert answer.status_code == 303, answer.text
    strategy = config(machine).strategy
    assert isinstance(strategy, Stepped)
    first, second = strategy.program.steps
    assert (first.from_h, first.first_deg, first.second_deg) == (8.5, 100.5, 30.25)
    assert (second.first_deg, second.second_deg) == (110.0, -2.5)


@pytest.mark.parametrize("offset", ["1e400", "NaN", "-Infinity", "9" * 400])
async def test_an_offset_that_is_no_number_is_refused(client: httpx.AsyncClient, offset: str) -> None:
    action = f"{STRATEGY}/program"
    head = {"base": "clock", "offset": offset, "at": "06:00", "first": "110", "second": "30"}
    answer = await client.post(action, data=await filled(client, STRATEGY, head, action=action))
    assert answer.status_code == 422
    assert "UTC offset: type hours" in answer.text


@pytest.mark.parametrize(
    "text", ["1" + " " * 100_000 + "m2x2", "1" * 100_000 + "x", "1" + ",000" * 25_000 + "x"], ids=len
)
def test_a_long_text_is_refused_in_time_by_its_length(text: str) -> None:
    with pytest.raises(Unreadable):
        number(text, "Length", 0, 1e6, "m")


@pytest.mark.parametrize("text", ["1" + " " * 100_000 + "x", " " * 50_000 + "1" + " " * 50_000], ids=len)
async def test_a_long_corner_is_refused_in_time_by_its_length(client: httpx.AsyncClient, text: str) -> None:
    page = f"{T1}/machine"
    form = await filled(client, page, {"region0_name": "Wall", "region0_corners": text})
    answer = await client.post(page, data=form)
    assert answer.status_code == 422
    assert 'id="region0_corners-error"' in answer.text
