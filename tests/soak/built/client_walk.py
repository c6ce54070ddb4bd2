"""A foreign program: commissions T1 through the generated client alone, in the client's own environment.

`python client_walk.py FOLDER URL DRIVE_PORT`: FOLDER holds the package `heliopanel_client`.
"""

import datetime
import importlib
import io
import pkgutil
import sys
import time
from collections.abc import Callable
from typing import Any
from uuid import uuid4

URL, DRIVE_PORT, T1 = sys.argv[2], int(sys.argv[3]), "T1"
sys.path.insert(0, sys.argv[1])

import heliopanel_client  # noqa: E402 - made by the test that calls this
from heliopanel_client import Client  # noqa: E402
from heliopanel_client import models as m  # noqa: E402
from heliopanel_client.types import UNSET, File  # noqa: E402

GENERATED = {
    one.name.rpartition(".")[2].partition("_api_v1_")[0]: one.name
    for one in pkgutil.walk_packages(heliopanel_client.__path__, "heliopanel_client.")
    if ".api." in one.name and not one.ispkg
}
CLIENT = Client(base_url=URL)
WITHIN_S = 30.0
TABLE = b"clock_time,azimuth_deg,elevation_deg\n06:00,90,20\n12:00,180,60\n"


def ask(name: str, *path: str, **given: Any) -> tuple[int, Any]:
    """Return the status and the typed answer of one generated call."""
    answer = importlib.import_module(GENERATED[name]).sync_detailed(*path, client=CLIENT, **given)
    return int(answer.status_code), answer.parsed


def call(kind: type, name: str, *path: str, **given: Any) -> Any:
    """Return the answer, which must be of its type."""
    status, parsed = ask(name, *path, **given)
    assert isinstance(parsed, kind), (name, status, parsed)
    return parsed


def until(reached: Callable[[Any], object]) -> Any:
    """Return the first snapshot of T1 that is so."""
    ends = time.monotonic() + WITHIN_S
    while not reached(seen := call(m.Snapshot, "read_snapshot", T1)):
        assert time.monotonic() < ends, seen
        time.sleep(0.1)
    return seen


def until_allowed(action: str) -> None:
    until(lambda seen: seen.actions[action] == [])


def command(body: Any, **more: Any) -> Any:
    return call(m.Snapshot, "send_command", T1, body=body, **more)


def import_everything() -> None:
    for name in GENERATED.values():
        assert importlib.import_module(name).sync_detailed


def configure() -> None:
    (config,) = call(m.TrackerConfigPage, "list_trackers").items
    assert isinstance(config, m.TrackerConfig), config
    assert isinstance(config.drive, m.DriveConfig)
    drive = m.DriveConfigChange(
        kind=m.DriveKind("modbus-tcp"), profile="simulated-plc", host="127.0.0.1", port=DRIVE_PORT
    )
    changed = call(m.TrackerConfig, "change_tracker", T1, body=m.TrackerConfigChange(drive=drive))
    assert changed.drive.port == DRIVE_PORT
    until_allowed("jog")


def place_and_time() -> None:
    place = m.SitePlace(
        latitude_deg=41.2867, longitude_deg=36.33, altitude_m=4.0, time_zone="Europe/Istanbul", confirmed=True
    )
    call(m.SiteSnapshot, "set_location", body=place)
    at = datetime.datetime.fromisoformat("2027-06-21T06:00:00+03:00")
    clock = m.ClockChange(source=m.ClockChangeSource("manual"), at=at, confirmed=True)
    call(m.Clock, "set_clock", body=clock)


def home_and_track() -> None:
    until_allowed("set_home")
    command(m.SetHomeCommand(type_="set_home", confirmed=True))
    until(lambda seen: seen.homed)
    command(m.SetModeCommand(type_="set_mode", mode=m.Mode("dual")))
    steps = call(m.StepPage, "read_steps", T1).items
    done = {one.name.value for one in steps if one.status.value == "done"}
    assert done == {"location", "clock", "homing", "mode"}
    command(m.TrackCommand(type_="track"))
    until(lambda seen: seen.tracking_on and seen.measured is not None)
    call(m.Snapshot, "stop_tracker", T1)
    until(lambda seen: not seen.tracking_on)
    until_allowed("set_home")


def reuse_a_key() -> None:
    key = uuid4().hex
    home, dual = m.ParkCommand(type_="park"), m.SetModeCommand(type_="set_mode", mode=m.Mode("dual"))
    command(dual, idempotency_key=key)
    command(dual, idempotency_key=key)
    status, problem = ask("send_command", T1, body=home, idempotency_key=key)
    assert status == 409, problem
    assert isinstance(problem, m.ProblemDetails)
    assert [one.code for one in problem.reasons] == ["key_reused"]


def settings_and_studies() -> None:
    call(m.StepProgram, "write_program_table", T1, body=File(payload=io.BytesIO(TABLE)))
    call(m.CommissioningRecord, "read_commissioning_record", T1)
    assert isinstance(call(m.TrackerConfig, "undo_settings", T1), m.TrackerConfig)
    study = m.NewStudy(date=datetime.date(2026, 6, 21), span=m.Span("day"))
    begun = call(m.StudyState, "start_study", body=study)
    assert call(m.Study, "read_study", begun.study_id).request is not UNSET
    restored = importlib.import_module(GENERATED["restore_drive"])
    assert "TrackerConfig" in str(restored.sync.__annotations__["return"])
    added = call(m.TrackerConfig, "add_tracker", body=m.NewTracker(tracker_id="T9", name="Ninth"))
    assert added.tracker_id == "T9"


if __name__ == "__main__":
    import_everything()
    configure()
    place_and_time()
    home_and_track()
    reuse_a_key()
    settings_and_studies()
    print(f"{len(GENERATED)} calls were generated; T1 is commissioned.")
