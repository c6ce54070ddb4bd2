"""The mount's page: kinds, rows, actuators, what was typed wrongly, and the wizard that follows."""

import httpx

from app.site.state.validation import check_config
from app.tracker.settings.config import Orientation
from tests.fakes import FakeMachine
from tests.web.filled import filled

MOUNT = "/trackers/T1/mount"
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


async def chosen(client: httpx.AsyncClient, kind: str) -> None:
    answer = await client.post(f"{MOUNT}/kind", data={"kind": kind})
    assert answer.status_code == 303


async def test_a_named_actuator_narrows_limits_and_speed(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    await chosen(client, "equatorial")
    typed = {"axis_azimuth": "180", "axis_tilt": "41.3", "first_actuator": "alexandru-diurnal"}
    assert (await client.post(MOUNT, data=await filled(client, MOUNT, typed))).status_code == 303
    axis = machine.orders[-1].command.config.azimuth
    assert (axis.minimum_deg, axis.maximum_deg) == (-60.0, 60.0)
    assert axis.speed_dps <= axis.actuator.slowest_dps(-60.0, 60.0)
    assert "Hour angle: stroke and transmission angle" in (await client.get(MOUNT)).text


async def test_an_actuator_of_the_azimuth_axis_takes_the_park_position_along(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    typed = {f"first_{name}": value for name, value in LOW.items()} | {"first_actuator": "own"}
    park = {"park": {"azimuth_deg": 150.0, "elevation_deg": 60.0}}
    assert (await client.patch("/api/v1/trackers/T1", json=park)).status_code == 200
    assert (await client.post(MOUNT, data=await filled(client, MOUNT, typed))).status_code == 303
    config = machine.orders[-1].command.config
    assert 20.0 < config.azimuth.maximum_deg < 90.0
    assert config.park == Orientation(config.azimuth.maximum_deg, 60.0), "the nearest that is left"
    check_config(config)


async def test_the_wizard_and_the_settings_follow_the_mount(client: httpx.AsyncClient) -> None:
    await chosen(client, "vertical-single-axis")
    homing = (await client.get("/trackers/T1/commissioning/homing")).text
    assert "Move the axis to its home position" in homing
    assert 'data-jog="elevation"' not in homing
    modes = (await client.get("/trackers/T1/commissioning/mode")).text
    assert "Single-axis tracking" in modes
    assert "Elevation tracking" not in modes
    settings = (await client.get("/trackers/T1/settings")).text
    assert "Rotation axis" in settings
    assert "elevation_minimum_deg" not in settings


async def test_what_cannot_be_is_refused_and_an_unknown_kind_too(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    typed = {f"second_{name}": value for name, value in LOW.items()} | {"second_actuator": "own"}
    wrong = await filled(client, MOUNT, typed | {"second_travel": "900"})
    answer = await client.post(MOUNT, data=wrong)
    assert (answer.status_code, "it cannot go" in answer.text) == (422, True)
    assert (await client.post(f"{MOUNT}/kind", data={"kind": "alt-alt"})).status_code == 422
    assert not machine.orders
    await client.post(MOUNT, data=await filled(client, MOUNT, typed))
    config = machine.orders[-1].command.config
    assert config.park.elevation_deg == config.elevation.maximum_deg < 90.0, "the park position went along"
