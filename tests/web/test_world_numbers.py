"""Numbers as keyboards, phones, and word processors write them: taken as they are meant, or refused."""

from collections.abc import Callable
from dataclasses import replace
from html import unescape

import httpx
import pytest

from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.settings.strategy import Stepped
from tests.amount import amount
from tests.fakes import FakeMachine
from tests.golden.table import rows
from tests.web.filled import filled

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


@pytest.mark.parametrize("offset", ["1e400", "NaN", "-Infinity", "9" * 400])
async def test_an_offset_that_is_no_number_is_refused(client: httpx.AsyncClient, offset: str) -> None:
    action = f"{STRATEGY}/program"
    head = {"base": "clock", "offset": offset, "at": "06:00", "first": "110", "second": "30"}
    answer = await client.post(action, data=await filled(client, STRATEGY, head, action=action))
    assert answer.status_code == 422
    assert "UTC offset: type hours" in answer.text
