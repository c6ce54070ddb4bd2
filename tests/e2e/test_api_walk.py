"""The five steps, tracking and a show on a drive behind Modbus TCP, through the REST API alone.

The midnight sun stands near the zero of the azimuth: the panel is soon there.
"""

import io
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet
import pytest

from tests.e2e.integrator import Integrator, Refused
from tests.e2e.product import DriveSim, eventually
from tests.e2e.sky import columns, off_spa_deg, off_sun_deg

DEADBAND_DEG = 0.5
SPA_LIMIT_DEG = 0.01
LONGYEARBYEN = {
    "latitude_deg": 78.22,
    "longitude_deg": 15.63,
    "altitude_m": 4.0,
    "time_zone": "Arctic/Longyearbyen",
}
AFTER_MIDNIGHT = "2027-06-21T01:30:00+02:00"
SHOWN_S = 75 * 60
SHOW = {
    "start": "2027-06-21T02:00:00+02:00",
    "end": "2027-06-21T03:15:00+02:00",
    "duration_s": 10,
}
JOGGED_S = 0.7
RERUN_S = 1.0


def commission_by_hand(integrator: Integrator, port: int) -> None:
    assert states(integrator)["location"] == "to_do"
    integrator.connect(port, refraction=False, deadband_deg=DEADBAND_DEG)
    integrator.place_and_time(AFTER_MIDNIGHT, LONGYEARBYEN)
    integrator.until(lambda seen: len(seen["actions"]["track"]) == 2, "place and time are known")
    assert set(codes_of(integrator, "track")) == {"tracker_not_homed", "mode_not_selected"}
    before = integrator.snapshot()["measured"]["azimuth_deg"]
    integrator.jog(JOGGED_S)
    integrator.until_allowed("set_home")
    assert integrator.snapshot()["measured"]["azimuth_deg"] > before + 0.5
    integrator.zero()
    integrator.command("set_mode", mode="dual")
    assert set(states(integrator).values()) <= {"done", "to_do"}


def states(integrator: Integrator) -> dict[str, str]:
    return {step["name"]: step["status"] for step in integrator.get("/commissioning")["items"]}


def codes_of(integrator: Integrator, action: str) -> list[str]:
    with pytest.raises(Refused) as refused:
        integrator.command(action)
    assert refused.value.status == 409
    return refused.value.codes


def track(integrator: Integrator) -> None:
    integrator.command("track")
    seen = integrator.until(
        lambda seen: seen["in_position"] and (seen["off_sun_deg"] or 90.0) <= DEADBAND_DEG,
        "the panel faces the sun",
    )
    assert seen["activity"] == "tracking"
    assert seen["tracking_on"]


def run_show(integrator: Integrator) -> str:
    planned = integrator.post("/shows", SHOW)
    assert planned["feasible"], planned["reasons"]
    assert planned["reasons"] == []
    act(integrator, planned["show_id"], "go-to-start")
    run_when_ready(integrator, planned["show_id"])
    integrator.until(lambda seen: seen["show"] is None, "the show is over")
    return str(planned["show_id"])


def act(integrator: Integrator, show_id: str, action: str) -> Any:
    return integrator.post(f"/shows/{show_id}/{action}")


def run_when_ready(integrator: Integrator, show_id: str) -> None:
    integrator.until(
        lambda seen: seen["show"] and seen["show"]["phase"] == "ready", "the panel stands at the start"
    )
    act(integrator, show_id, "run")


def test_walk_with_the_api_alone(integrator: Integrator, drive: DriveSim) -> None:
    commission_by_hand(integrator, drive.port)
    track(integrator)
    run_show(integrator)
    info = finished_show(integrator)
    frames = check_frames(integrator, info)
    check_files(integrator, info["recording_id"], frames)
    check_day(integrator)
    check_rerun(integrator, info["recording_id"])


def finished_show(integrator: Integrator) -> dict[str, Any]:
    """Return the head of the newest show once the store has its end."""

    def newest() -> dict[str, Any]:
        return dict(integrator.get("/api/v1/recordings", kind="show")["items"][0])

    eventually(lambda: newest()["ended_at"], "the recording is finished")
    info = newest()
    assert info["outcome"] == "completed"
    return info


def check_frames(integrator: Integrator, info: dict[str, Any]) -> dict[str, np.ndarray]:
    answer = integrator.get(f"/api/v1/recordings/{info['recording_id']}/samples")
    frames = columns(answer)
    assert answer["sample_count"] == info["sample_count"] >= SHOW["duration_s"] * 9
    assert frames["sun_time_s"][0] == pytest.approx(0.0, abs=60.0)
    assert frames["sun_time_s"][-1] == pytest.approx(SHOWN_S, abs=80.0)
    unknown = {name for name, values in frames.items() if np.isnan(values).any()}
    assert unknown <= {"supply_v", "wind_mps", "wind_mean_mps", "irradiance_wm2"}
    assert off_spa_deg(info, frames).max() < SPA_LIMIT_DEG
    assert off_sun_deg(frames).max() <= DEADBAND_DEG
    return frames


def check_files(integrator: Integrator, recording_id: str, frames: dict[str, np.ndarray]) -> None:
    path = f"/api/v1/recordings/{recording_id}/samples"
    csv = pd.read_csv(io.StringIO(integrator.call("GET", path, params={"format": "csv"}).text), comment="#")
    parquet = pyarrow.parquet.read_table(
        io.BytesIO(integrator.call("GET", path, params={"format": "parquet"}).content)
    )
    for name in set(frames) - {"activity"}:
        np.testing.assert_allclose(csv[name], frames[name], atol=1e-3)
        np.testing.assert_allclose(parquet[name].to_numpy(), frames[name], atol=1e-9)
    few = integrator.get(path, points=40)
    assert 18 <= few["sample_count"] <= 40
    page = integrator.http.get(f"/recordings/{recording_id}")
    assert page.status_code == 200
    assert recording_id in page.text


def check_day(integrator: Integrator) -> None:
    """The day's recording has the real sun in every frame, also while the show followed another."""
    (day,) = integrator.get("/api/v1/recordings", kind="day")["items"]
    frames = columns(integrator.get(f"/api/v1/recordings/{day['recording_id']}/samples"))
    assert off_spa_deg(day, frames).max() < SPA_LIMIT_DEG


def check_rerun(integrator: Integrator, recording_id: str) -> None:
    answer = integrator.call(
        "POST", f"/api/v1/recordings/{recording_id}/rerun", json={"duration_s": SHOW["duration_s"]}
    )
    show_id = answer.headers["Location"].rpartition("/")[2]
    run_when_ready(integrator, show_id)
    integrator.until(lambda seen: seen["show"]["elapsed_s"] > RERUN_S, "the show runs again")
    act(integrator, show_id, "stop")

    integrator.until(lambda seen: seen["show"] is None, "the show is over")
    again, first = integrator.get("/api/v1/recordings", kind="show")["items"]
    assert first["recording_id"] == recording_id
    for name in ("sun_start", "sun_end", "mode", "location"):
        assert again[name] == first[name]
