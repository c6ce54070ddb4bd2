"""The mount's page: kinds, rows, actuators, what was typed wrongly, and the wizard that follows."""

from collections.abc import AsyncIterator

import httpx
import pytest

from app.site.state.validation import check_config
from app.tracker.settings.config import Orientation
from tests.fakes import FakeMachine, fake_app, serving
from tests.web.filled import filled

MOUNT = "/trackers/T1/mount"
OWN = {"base_x": "900", "base_y": "0", "base_z": "15", "joint_x": "132.5", "joint_y": "200.1", "joint_z": "0"}
LOW = {
    "base_x": "800",
    "base_y": "-300",
    "base_z": "0",
    "joint_x": "250",
    "joint_y": "100",
    "joint_z": "0",
    "at": "0",
    "retracted": "600",
    "travel": "300",
    "speed": "8",
}
SIZES = {"at": "0", "retracted": "745", "travel": "385", "speed": "25"}


@pytest.fixture
async def browser(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        yield client


async def chosen(browser: httpx.AsyncClient, kind: str) -> None:
    answer = await browser.post(f"{MOUNT}/kind", data={"kind": kind})
    assert answer.status_code == 303


async def test_the_page_shows_every_kind_and_the_reach_of_the_year(browser: httpx.AsyncClient) -> None:
    page = (await browser.get(MOUNT)).text
    for title in ("Azimuth and elevation", "Equatorial", "Tilted single axis", "Vertical single axis"):
        assert title in page
    assert "<b>0.0 %</b> of the time with the sun up" in page
    assert "sun within reach" in page


async def test_rows_are_drawn_once_they_are_saved(browser: httpx.AsyncClient, machine: FakeMachine) -> None:
    await chosen(browser, "horizontal-single-axis")
    typed = {"axis_azimuth": "180", "rows": "yes", "ratio": "0,45", "slope": "5"}
    assert (await browser.post(MOUNT, data=await filled(browser, MOUNT, typed))).status_code == 303
    rows = machine.orders[-1].command.config.mount.rows
    assert (rows.ground_coverage_ratio, rows.cross_axis_tilt_deg) == (0.45, 5.0)
    assert "so that no row shades the next" in (await browser.get(MOUNT)).text


async def test_a_wrong_ratio_is_told_and_what_was_typed_stays(browser: httpx.AsyncClient) -> None:
    await chosen(browser, "tilted-single-axis")
    typed = {"axis_azimuth": "180", "axis_tilt": "25", "rows": "yes", "ratio": "4.5", "slope": "0"}
    answer = await browser.post(
        MOUNT, data=await filled(browser, MOUNT, typed), headers={"HX-Request": "true"}
    )
    assert answer.status_code == 422
    assert "Ground coverage ratio must be between 0.01 and 1." in answer.text
    assert 'value="4.5"' in answer.text


async def test_a_named_actuator_narrows_limits_and_speed(
    browser: httpx.AsyncClient, machine: FakeMachine
) -> None:
    await chosen(browser, "equatorial")
    typed = {"axis_azimuth": "180", "axis_tilt": "41.3", "first_actuator": "alexandru-diurnal"}
    assert (await browser.post(MOUNT, data=await filled(browser, MOUNT, typed))).status_code == 303
    axis = machine.orders[-1].command.config.azimuth
    assert (axis.minimum_deg, axis.maximum_deg) == (-60.0, 60.0)
    assert axis.speed_dps <= axis.actuator.slowest_dps(-60.0, 60.0)
    assert "Hour angle: stroke and transmission angle" in (await browser.get(MOUNT)).text


async def test_an_actuator_by_its_points_and_one_that_cannot_be_built(
    browser: httpx.AsyncClient, machine: FakeMachine
) -> None:
    points = {f"second_{name}": value for name, value in (OWN | SIZES).items()} | {"second_actuator": "own"}
    assert (await browser.post(MOUNT, data=await filled(browser, MOUNT, points))).status_code == 303
    assert machine.orders[-1].command.config.elevation.actuator.travel_mm == 385.0
    answer = await browser.post(MOUNT, data=await filled(browser, MOUNT, points | {"second_travel": "900"}))
    assert answer.status_code == 422
    assert "it cannot go" in answer.text


async def test_an_actuator_of_the_elevation_axis_takes_the_park_position_along(
    browser: httpx.AsyncClient, machine: FakeMachine
) -> None:
    typed = {f"second_{name}": value for name, value in LOW.items()} | {"second_actuator": "own"}
    await browser.post(MOUNT, data=await filled(browser, MOUNT, typed))
    config = machine.orders[-1].command.config
    assert config.elevation.maximum_deg < 90.0
    assert config.park.elevation_deg == config.elevation.maximum_deg


async def test_an_actuator_of_the_azimuth_axis_takes_the_park_position_along(
    browser: httpx.AsyncClient, machine: FakeMachine
) -> None:
    typed = {f"first_{name}": value for name, value in LOW.items()} | {"first_actuator": "own"}
    park = {"park": {"azimuth_deg": 150.0, "elevation_deg": 60.0}}
    assert (await browser.patch("/api/v1/trackers/T1", json=park)).status_code == 200
    assert (await browser.post(MOUNT, data=await filled(browser, MOUNT, typed))).status_code == 303
    config = machine.orders[-1].command.config
    assert 20.0 < config.azimuth.maximum_deg < 90.0
    assert config.park == Orientation(config.azimuth.maximum_deg, 60.0), "the nearest that is left"
    check_config(config)


async def test_what_the_machine_refuses_comes_back_in_the_form(
    browser: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.refusal = "The park position lies outside the soft limits."
    typed = {f"second_{name}": value for name, value in (OWN | SIZES).items()} | {"second_actuator": "own"}
    answer = await browser.post(
        MOUNT, data=await filled(browser, MOUNT, typed), headers={"HX-Request": "true"}
    )
    assert answer.status_code == 422
    assert answer.text.lstrip().startswith("<form")
    assert "The park position lies outside the soft limits." in answer.text
    assert 'value="132.5"' in answer.text


async def test_the_wizard_and_the_settings_follow_the_mount(browser: httpx.AsyncClient) -> None:
    await chosen(browser, "vertical-single-axis")
    homing = (await browser.get("/trackers/T1/commissioning/homing")).text
    assert "Move the axis to its home position" in homing
    assert 'data-jog="elevation"' not in homing
    modes = (await browser.get("/trackers/T1/commissioning/mode")).text
    assert "Single-axis tracking" in modes
    assert "Elevation tracking" not in modes
    settings = (await browser.get("/trackers/T1/settings")).text
    assert "Rotation axis" in settings
    assert "elevation_minimum_deg" not in settings


async def test_an_unknown_kind_is_refused(browser: httpx.AsyncClient) -> None:
    answer = await browser.post(f"{MOUNT}/kind", data={"kind": "alt-alt"})
    assert answer.status_code == 422
    assert "Choose one of the mounts in the list." in answer.text
