"""Setting a drive up and proving it over pages and API, with the real site behind them on a virtual clock."""

import re
from typing import Any

import httpx
import pytest

from app.link.messages import CheckConnection, ConfigureTracker
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.tracker.memory.drive_check import CheckOutcome, DriveCheck, DriveReadings, RegisterReading
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveKind, Parity
from app.web.features.commissioning.drive_form import DriveForm
from tests.fakes import FakeMachine
from tests.web.desk import Desk
from tests.web.filled import values_of

T1 = "/trackers/T1"
API = "/api/v1/trackers/T1"
HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
TYPED = DriveForm().model_dump() | {
    "kind": "modbus-rtu", "profile": "simulated-plc", "serial_other": "/dev/ttyUSB7", "baud_rate": "38400",
    "parity": "none", "stop_bits": "2", "unit": "3", "azimuth_gear": "1,25", "azimuth_unit": "4",
    "azimuth_inverted": "yes", "elevation_gear": "1", "elevation_steps": "10000",
}  # fmt: skip


@pytest.fixture(autouse=True)
async def begun(desk: Desk) -> None:
    await desk.forward(0.5)


async def rest(desk: Desk) -> None:
    """Let time pass until the tracker holds again."""
    for _ in range(60):
        await desk.forward(0.5)
        if (await desk.ask("GET", f"{API}/snapshot")).json()["activity"] == "holding":
            await desk.forward(0.5)
            return
    raise AssertionError("the tracker does not come to rest")


async def proofs(desk: Desk) -> dict[tuple[str, str | None, str | None], dict[str, Any]]:
    states = (await desk.ask("GET", f"{API}/drive-tests")).json()["states"]
    return {(one["kind"], one["axis"], one["speed"]): one for one in states}


async def command(desk: Desk, kind: str, **more: object) -> httpx.Response:
    return await desk.ask("POST", f"{API}/commands", json={"type": kind, **more})


async def test_the_api_proves_a_drive_as_the_page_does(desk: Desk) -> None:
    assert {one["status"] for one in (await proofs(desk)).values()} == {"to_do"}
    started = await command(desk, "test_direction", axis="elevation")
    assert (started.status_code, started.json()["activity"]) == (202, "moving")
    await rest(desk)
    judged = await desk.ask("POST", f"{API}/drive-tests/direction", json={"right": True})
    assert judged.json()["measured"]["directions"][0]["moved_deg"] == pytest.approx(3.0, abs=0.1)
    await command(desk, "test_scale", axis="elevation", delta_deg=10)
    await rest(desk)
    await desk.ask("POST", f"{API}/drive-tests/scale", json={"measured_deg": 10.1})
    started = await command(desk, "test_stop", axis="elevation", speed="jog")
    assert started.json()["activity"] == "measuring"
    await rest(desk)
    await command(desk, "test_communication_loss", axis="azimuth")
    await rest(desk)
    after = await proofs(desk)
    done = {key for key, one in after.items() if one["status"] == "done"}
    assert done == {
        ("direction", "elevation", None),
        ("scale", "elevation", None),
        ("stop", "elevation", "jog"),
        ("link_loss", None, None),
    }


async def test_results_stand_in_the_record_as_json_page_html_and_pdf(desk: Desk) -> None:
    await command(desk, "test_stop", axis="azimuth", speed="jog")
    await rest(desk)
    await command(desk, "test_communication_loss", axis="azimuth")
    await rest(desk)
    record = (await desk.ask("GET", f"{API}/record")).json()
    (stop,) = record["measured"]["stops"]
    assert stop["stopped_after_s"] == pytest.approx(0.5, abs=0.11)
    assert stop["overrun_deg"] == pytest.approx(0.75, abs=0.1)
    assert record["measured"]["link_loss"]["outcome"] == "stopped"
    assert record["measured"]["link_loss"]["expected_s"] == 0.5
    page = (await desk.ask("GET", f"{T1}/record")).text
    assert "Drive tests" in page
    assert "degrees after the stop command" in page
    html = (await desk.ask("GET", f"{API}/record", params={"format": "html"})).text
    assert "azimuth stop jog" in html
    assert "Without commands the drive slowed down after" in html
    pdf = (await desk.ask("GET", f"{API}/record", params={"format": "pdf"})).content
    assert pdf.startswith(b"%PDF")


async def test_what_cannot_be_is_refused_with_every_reason(desk: Desk) -> None:
    nothing = await desk.ask("POST", f"{API}/drive-tests/direction", json={"right": True})
    assert nothing.status_code == 409
    assert nothing.json()["reasons"][0]["code"] == "nothing_to_judge"
    rated = await command(desk, "test_stop", axis="azimuth", speed="rated")
    assert rated.json()["reasons"][0]["code"] == "tracker_not_homed"
    limit = await desk.ask("POST", f"{API}/drive-tests/limits", json={"axis": "azimuth", "end": "lower"})
    assert limit.status_code == 409
    assert (await desk.ask("POST", f"{API}/drive/undo")).status_code == 409
    assert (await command(desk, "test_scale", axis="azimuth", delta_deg=20)).status_code == 422
    no_tools = await desk.ask("POST", f"{API}/drive/check", json={"kind": "modbus-tcp", "port": 1})
    assert no_tools.json()["reasons"][0]["code"] == "no_drive_tools"


async def test_the_page_asks_in_words_and_turns_the_axis_round(desk: Desk) -> None:
    await desk.ask("POST", f"{T1}/drive-tests/direction", data={"axis": "azimuth"})
    await rest(desk)
    page = (await desk.ask("GET", f"{T1}/drive-tests")).text
    assert "Did the panel turn to the right, clockwise as seen from above?" in page
    block = (await desk.ask("GET", f"{T1}/drive-tests", headers=HTMX)).text
    assert "<html" not in block
    assert 'id="proofs"' in block
    refused = await desk.ask("POST", f"{T1}/drive-tests/direction/answer", data={"answer": "perhaps"})
    assert refused.status_code == 422
    await desk.ask("POST", f"{T1}/drive-tests/direction/answer", data={"answer": "wrong"})
    assert (await desk.ask("GET", API)).json()["drive"]["azimuth"]["inverted"] is True
    undone = await desk.ask("POST", f"{T1}/drive/restore")
    assert undone.headers["location"] == f"{T1}/drive?done=restored"
    assert (await desk.ask("GET", API)).json()["drive"]["azimuth"]["inverted"] is False


async def test_a_measured_angle_that_cannot_be_stays_as_it_was_typed(desk: Desk) -> None:
    await desk.ask("POST", f"{T1}/drive-tests/scale", data={"axis": "elevation", "way": "10"})
    await rest(desk)
    answer = await desk.ask("POST", f"{T1}/drive-tests/scale/answer", data={"measured": "ten"}, headers=HTMX)
    assert answer.status_code == 422
    assert 'value="ten"' in answer.text
    assert "Measured angle: type a number" in answer.text
    bad_way = await desk.ask("POST", f"{T1}/drive-tests/scale", data={"axis": "elevation", "way": "11"})
    assert bad_way.status_code == 422
    answer = await desk.ask("POST", f"{T1}/drive-tests/scale/answer", data={"measured": "300"}, headers=HTMX)
    assert answer.status_code == 422
    for words in ('id="proofs"', 'value="300"', "Enter the degrees that the panel turned"):
        assert words in re.sub(r"\s+", " ", answer.text), "the page stays whole"
    good = await desk.ask("POST", f"{T1}/drive-tests/scale/answer", data={"measured": "10,1"}, headers=HTMX)
    assert good.status_code == 200
    assert (await proofs(desk))["scale", "elevation", None]["status"] == "done"


async def test_settings_that_the_machine_refuses_come_back_in_the_form(desk: Desk) -> None:
    typed = TYPED | {"kind": "simulated", "elevation_gear": "3"}
    answer = await desk.ask("POST", f"{T1}/drive", data=typed, headers=HTMX)
    assert answer.status_code == 422
    for words in ('id="drive-form"', 'value="1,25"', "A gear ratio of 3 does not fit this drive"):
        assert words in re.sub(r"\s+", " ", answer.text), words


async def test_a_stopped_drive_is_cleared_where_it_is_proven(desk: Desk) -> None:
    page = f"{T1}/drive-tests"
    assert "Reset fault" not in (await desk.ask("GET", page)).text
    drive = desk.plant.drives["T1"]
    assert isinstance(drive, SimulatedDrive)
    drive.inject(Fault(FaultKind.WRONG_DIRECTION, Axis.ELEVATION))
    await desk.ask("POST", f"{page}/direction", data={"axis": "elevation"})
    for _ in range(12):
        await desk.forward(0.5)
    told = (await desk.ask("GET", page)).text
    assert "moves opposite to its command" in told
    assert "Reset fault" in told


async def test_drive_settings_are_saved_whole(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    answer = await client.post(f"{T1}/drive", data=TYPED)
    assert answer.headers["location"] == f"{T1}/drive?done=saved"
    (order,) = [one.command for one in machine.orders if isinstance(one.command, ConfigureTracker)]
    drive = order.config.drive
    assert (drive.kind, drive.unit) == (DriveKind.MODBUS_RTU, 3)
    assert (drive.serial.port, drive.serial.baud_rate) == ("/dev/ttyUSB7", 38400)
    assert (drive.serial.parity, drive.serial.stop_bits) == (Parity.NONE, 2)
    assert (drive.azimuth.unit, drive.azimuth.gear_ratio, drive.azimuth.inverted) == (4, 1.25, True)
    assert (drive.elevation.unit, drive.elevation.steps_per_revolution) == (None, 10000.0)
    page = (await client.get(f"{T1}/drive?done=saved")).text
    assert "The drive settings are saved." in page
    assert 'value="1.25"' in page


async def test_what_is_shown_and_saved_again_is_not_another_drive(desk: Desk) -> None:
    geared = {"gear_ratio": 1.1494252873563218, "steps_per_revolution": 1234567.5}
    assert (await desk.ask("PATCH", API, json={"drive": {"elevation": geared}})).status_code == 200
    before = (await desk.ask("GET", API)).json()["drive"]
    typed = values_of((await desk.ask("GET", f"{T1}/drive")).text, f"{T1}/drive")
    assert {"azimuth_gear", "azimuth_steps", "elevation_gear", "elevation_steps"} <= set(typed)
    assert (await desk.ask("POST", f"{T1}/drive", data=typed)).status_code == 303
    assert (await desk.ask("GET", API)).json()["drive"] == before


WRONG: list[tuple[dict[str, str], str]] = [
    ({"kind": "pigeon"}, "Connection: choose one from the list."),
    ({"profile": "../secrets"}, "Profile: choose one from the list."),
    ({"serial_other": ""}, "Serial port: choose one"),
    ({"kind": "modbus-tcp", "host": "", "port": "502"}, "Host: give the address"),
    ({"kind": "modbus-tcp", "host": "plc", "port": "abc"}, "Port: type a number"),
    ({"baud_rate": "12"}, "Baud rate must be between"),
    ({"unit": "0"}, "Unit must be between 1 and 247."),
    ({"azimuth_unit": "248"}, "Azimuth unit must be between 1 and 247."),
    ({"azimuth_gear": "-1"}, "Azimuth gear ratio must be between"),
    ({"elevation_steps": "many"}, "Elevation steps per revolution: type a number"),
]


@pytest.mark.parametrize("way", ["", "/test"])
async def test_wrong_settings_come_back_with_what_was_typed(
    way: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    for changed, sentence in WRONG:
        answer = await client.post(f"{T1}/drive{way}", data=TYPED | changed, headers=HTMX)
        assert answer.status_code == 422, changed
        assert sentence in re.sub(r"\s+", " ", answer.text)
        assert 'value="38400"' in answer.text or "baud_rate" in changed
    assert not machine.orders


async def test_the_connection_is_tested_with_what_was_typed_and_nothing_is_saved(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    await client.post(f"{T1}/drive/test", data=TYPED, headers=HTMX)
    (order,) = machine.orders
    assert isinstance(order.command, CheckConnection)
    assert order.command.drive.serial.port == "/dev/ttyUSB7"
    checked = await client.post(f"{API}/drive/check", json={"kind": "modbus-tcp", "host": "10.0.0.9"})
    assert checked.status_code == 404
    assert isinstance(machine.orders[-1].command, CheckConnection)
    assert machine.orders[-1].command.drive.host == "10.0.0.9"


async def test_a_look_at_the_drive_names_watchdog_action_and_unverified_registers(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    reading = RegisterReading("position", 12, 1, "3.5", "deg", "Axis angle", verified=False, source="a guess")
    refused = RegisterReading("speed", 14, 1, "", "", "", verified=True, source="manual", trouble="Refused.")
    answered = DriveReadings(
        CheckOutcome.ANSWERED, "The device answers.", (reading, refused), 0.4, "Both axes ramp down."
    )
    tracker = machine.trackers["T1"]
    tracker.check = DriveCheck(tracker.config.drive, machine.clock.now(), "operator", answered)
    shown = (await client.get(f"{T1}/drive")).text
    assert f'href="{API}/drive/check" download="registers-T1.json"' in shown
    page = re.sub(r"<[^>]+>|\s+", " ", shown)
    for words in ("0.4 s, read back", "Both axes ramp down.", "1 of 2 registers: position", "Refused."):
        assert words in re.sub(r" +", " ", page), words
    record = (await client.get(f"{API}/record", params={"format": "html"})).text
    assert "<th align='left'>unverified registers</th><td>position</td>" in record
    looked = await client.post(f"{API}/drive/check", json={})
    assert looked.json()["readings"]["registers"][0]["name"] == "position"
    assert (await client.get(f"{API}/drive/check")).json() == looked.json()
