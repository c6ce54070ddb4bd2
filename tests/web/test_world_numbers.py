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
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import AxisDrive, MountKind, TrackerConfig
from app.tracker.settings.declared import declared
from app.tracker.settings.mechanics import GUARDED, Corner, Region
from app.tracker.settings.mechanisms import alexandru_elevation
from app.tracker.values.typed_numbers import written
from app.web.features.setup import machine_forms
from app.web.shell.forms import Typed, Unreadable, number
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


def config(machine: FakeMachine) -> TrackerConfig:
    found = machine.trackers["T1"].config
    assert isinstance(found, TrackerConfig)
    return found


def ids(table: list[dict[str, str]]) -> list[str]:
    return [row["why"] for row in table]


def read(text: str, most: float, unit: str) -> str | float:
    """Return what a number is taken for, `refused`, or `asked` which of two it is."""
    try:
        return number(text, "Length", -most, most, unit)
    except Unreadable as why:
        return "asked" if "can be read in two ways" in str(why) else "refused"


@pytest.mark.parametrize("row", NUMBERS, ids=ids(NUMBERS))
def test_a_number_is_taken_as_it_is_meant_or_refused(row: dict[str, str]) -> None:
    for found, expected in (
        (read(row["text"], 999, "°"), row["stored"]),
        (read(row["text"], 1e7, "m"), row["thousands"]),
    ):
        assert found == (expected if expected in ("refused", "asked") else float(expected))


Read = Callable[[FakeMachine], float]
FIELDS: dict[str, tuple[str, str, Read]] = {
    "azimuth_off": (STRATEGY, f"{STRATEGY}/hybrid", lambda of: config(of).hybrid.simulated.azimuth_deg),
    "slope": (f"{T1}/mount", f"{T1}/mount", lambda of: config(of).mount.rows.cross_axis_tilt_deg),
    "azimuth_minimum_deg": (f"{T1}/settings", f"{T1}/settings", lambda of: config(of).azimuth.minimum_deg),
    "altitude": (
        f"{T1}/commissioning/location",
        f"{T1}/commissioning/location",
        lambda of: of.site.location.altitude_m,
    ),
    "azimuth_gear": (f"{T1}/drive", f"{T1}/drive", lambda of: config(of).drive.azimuth.gear_ratio),
}
"""A field of each reader of a form: its page, its form, and where its number is stored."""


@pytest.mark.parametrize("name", FIELDS)
async def test_every_reader_of_a_form_takes_numbers_so(
    name: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page, action, stored = FIELDS[name]
    if name == "slope":
        tracker = machine.trackers["T1"]
        tracker.config = mounted(tracker.config, MountKind.HORIZONTAL_SINGLE_AXIS, 41.0)
        tracker.memory = replace(tracker.memory, home=None)
    rest = {"rows": "yes"} if name == "slope" else {}
    for text in ("—1.5", "1 degree") + (("1,200",) if name in ("altitude", "azimuth_gear") else ()):
        before = machine.site, config(machine)
        form = await filled(client, page, rest | {name: text}, action=action)
        answer = await client.post(action, data=form)
        assert answer.status_code == 422
        assert f'id="{name}-error"' in answer.text, "beside the field"
        assert f'value="{text}"' in unescape(answer.text), "what was typed stays"
        assert ("can be read in two ways" in answer.text) == (text == "1,200")
        assert (machine.site, config(machine)) == before
    answer = await client.post(action, data=await filled(client, page, rest | {name: "１,٥"}, action=action))
    assert answer.status_code < 400, answer.text
    assert stored(machine) == 1.5


@pytest.mark.parametrize(
    ("language", "text", "sentence"),
    [
        ("en", "1,200", "Altitude: 1,200 can be read in two ways. Type 1200 or 1.2."),
        ("en", "-1,000", "Altitude: -1,000 can be read in two ways. Type -1000 or -1."),
        ("en", "1200 ft", "Altitude: type the number alone, without a unit."),
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
        ("5'020", ""),
        ("5020,0", ""),
    ],
)
async def test_a_whole_number_is_never_guessed(
    machine: FakeMachine, client: httpx.AsyncClient, text: str, sentence: str
) -> None:
    form = await filled(client, f"{T1}/drive", {"kind": "modbus-tcp", "host": "127.0.0.1", "port": text})
    answer = await client.post(f"{T1}/drive", data=form)
    assert answer.status_code == (422 if sentence else 303)
    assert sentence in unescape(answer.text)
    assert sentence or config(machine).drive.port == 5020


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
    assert machine.site.location is not None
    machine.site = replace(machine.site, location=replace(machine.site.location, altitude_m=4.125))
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


@pytest.mark.parametrize("page", ["settings", "drive", "machine"])
async def test_numbers_are_stored_again_as_they_were(
    machine: FakeMachine, client: httpx.AsyncClient, page: str
) -> None:
    machine.trackers["T1"].config = before = awkward(config(machine))
    form = await filled(client, f"{T1}/{page}")
    answer = await client.post(f"{T1}/{page}", data=form)
    assert answer.status_code == 303, answer.text
    assert await filled(client, f"{T1}/{page}") == form
    assert replace(config(machine), elevation=before.elevation) == before


@given(st.integers(-999_999, 999_999).map(lambda found: found / 1000), st.sampled_from([999, 1000, 1e9]))
def test_a_number_is_read_as_it_is_written(value: float, most: float) -> None:
    shown = written(value, most)
    assert "e" not in shown
    assert number(shown, "Length", -1e6, max(value + 1, most)) == pytest.approx(value, rel=1e-9, abs=0)


LONG = ["1" + " " * 100_000 + "x", " " * 50_000 + "1" + " " * 50_000]


@pytest.mark.parametrize("row", CORNERS, ids=ids(CORNERS))
def test_corners_are_taken_or_refused_in_their_field(row: dict[str, str]) -> None:
    typed = Typed({"regions": "", "region0_name": "Wall", "region0_corners": row["text"]})
    drawn = machine_forms.drawable(typed)
    if row["stored"] == "refused":
        assert (list(typed.errors), drawn) == (["region0_corners"], ())
    else:
        assert not typed.errors
        assert machine_forms.texts(replace(GUARDED, regions=drawn))["region0_corners"] == row["stored"]


@pytest.mark.parametrize("text", LONG, ids=len)
def test_a_long_corner_is_refused_in_time_by_its_length(text: str) -> None:
    typed = Typed({"regions": "", "region0_name": "Wall", "region0_corners": text})
    assert machine_forms.drawable(typed) == ()
    assert "region0_corners" in typed.errors


@pytest.mark.parametrize(
    "text", ["1" + " " * 100_000 + "m2x2", "1" * 100_000 + "x", "1" + ",000" * 25_000 + "x"], ids=len
)
def test_a_long_text_is_refused_in_time_by_its_length(text: str) -> None:
    with pytest.raises(Unreadable):
        number(text, "Length", 0, 1e6, "m")
