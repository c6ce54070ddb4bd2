"""A home position that is likely to be mistaken is asked about, on the page and of programs; it is undone."""

import httpx
import pytest

from app.tracker.commands.commands import SetHome, UndoHome
from app.tracker.state.snapshot import Pair
from tests.fakes import FakeMachine

T1 = "/trackers/T1"
COMMANDS = "/api/v1/trackers/T1/commands"
HTMX = {"HX-Request": "true"}
AZIMUTH = "The measured azimuth is 102.4°. Does the panel really face north (0°)?"
ELEVATION = "The measured elevation is 36.6°. Is the panel really vertical (0°)?"


def sent(machine: FakeMachine, kind: type) -> list[object]:
    return [order.command for order in machine.orders if isinstance(order.command, kind)]


def stand(machine: FakeMachine, azimuth_deg: float, elevation_deg: float) -> None:
    machine.trackers["T1"].position = Pair(azimuth_deg, elevation_deg)
    machine.emit()


async def test_a_page_asks_before_it_is_believed(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    stand(machine, 102.4, 36.6)
    asked = await client.post(f"{T1}/zero", headers=HTMX)
    assert asked.status_code == 422
    assert AZIMUTH in asked.text
    assert ELEVATION in asked.text
    assert 'name="confirmed" value="102.4 36.6"' in asked.text
    whole = await client.post(f"{T1}/zero")
    assert (whole.status_code, AZIMUTH in whole.text) == (422, True)
    assert not sent(machine, SetHome)
    for other in ("yes", "102.4", "102.8 36.6", "102.4 nan"):
        again = await client.post(f"{T1}/zero", data={"confirmed": other}, headers=HTMX)
        assert again.status_code == 422, "it was asked about other readings"
    assert not sent(machine, SetHome)
    done = await client.post(f"{T1}/zero", data={"confirmed": "102.5 36.5"}, headers=HTMX)
    assert done.status_code == 200
    assert len(sent(machine, SetHome)) == 1


async def test_a_program_confirms_as_for_a_place(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    stand(machine, 102.4, 1.9)
    asked = await client.post(COMMANDS, json={"type": "set_home"})
    assert asked.status_code == 422
    assert (
        asked.json()["detail"]
        == f"{AZIMUTH} If the panel is at the home position, send the request again with `confirmed`."
    )
    assert (await client.post(COMMANDS, json={"type": "set_home", "axes": ["elevation"]})).status_code == 202
    assert (await client.post(COMMANDS, json={"type": "set_home", "confirmed": True})).status_code == 202
    assert len(sent(machine, SetHome)) == 2


@pytest.mark.parametrize(("read_deg", "asks"), [(2.0, False), (2.1, True), (-2.1, True)])
async def test_within_what_the_eye_can_tell_nothing_is_asked(
    machine: FakeMachine, client: httpx.AsyncClient, read_deg: float, asks: bool
) -> None:
    stand(machine, read_deg, 0.0)
    assert (await client.post(f"{T1}/zero", headers=HTMX)).status_code == (422 if asks else 200)


async def test_it_is_undone_from_the_page_and_by_a_program(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    for undo in ((f"{T1}/zero/undo", None), (COMMANDS, {"type": "undo_home"})):
        stand(machine, 102.4, 36.6)
        await client.post(COMMANDS, json={"type": "set_home", "confirmed": True})
        assert "Undo the home position" in (await client.get(f"{T1}/commissioning/homing")).text
        path, body = undo
        answer = await client.post(path, json=body) if body else await client.post(path, headers=HTMX)
        assert answer.status_code in (200, 202)
        assert machine.trackers["T1"].position == Pair(102.4, 36.6)
    assert len(sent(machine, UndoHome)) == 2
