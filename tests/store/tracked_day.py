"""A day as a tracker records it: one frame a second, steps of the deadband, encoder counts, a late tick."""

from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from app.sun.position import Algorithm, Location, sun_path
from app.tracker.memory.recording import Frames, RecordingInfo, RecordingKind
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode

SAMSUN = Location(41.2867, 36.33)
MIDNIGHT = datetime(2026, 6, 21, tzinfo=UTC)
DEADBAND_DEG = 0.5
ENCODER_DEG = 0.01
SPEED_DPS = 6.0


def day_info(recording_id: str = "day-1", *, kind: RecordingKind = RecordingKind.DAY) -> RecordingInfo:
    """Return the head that belongs to the day."""
    return RecordingInfo(
        recording_id=recording_id,
        kind=kind,
        tracker_id="T1",
        tracker_name="Tracker 1",
        title="21 June",
        began_at=MIDNIGHT,
        sun_start=MIDNIGHT,
        sun_end=MIDNIGHT + timedelta(days=1),
        duration_s=86400.0,
        location=SAMSUN,
        time_zone="Europe/Istanbul",
        mode=Mode.DUAL,
        held_azimuth_deg=180.0,
        held_elevation_deg=45.0,
        algorithm="psa",
        drive="simulated",
    )


def tracked_day(seconds: int = 86400, *, begin_s: float = 0.0) -> Frames:
    """Return a day at Samsun: tracked while the sun is up, held at night, readings lost for a minute."""
    chance = np.random.default_rng(1)
    elapsed_s = begin_s + np.arange(seconds) + np.abs(chance.normal(0.0, 0.001, seconds))
    path = sun_path(Algorithm.PSA, SAMSUN, MIDNIGHT.timestamp() + elapsed_s)
    up = path.apparent_elevation_deg > 0.0
    azimuth, elevation = path.azimuth_deg, path.apparent_elevation_deg
    setpoints = _steps(azimuth, up), _steps(elevation, up)
    measured = [_followed(setpoint) for setpoint in setpoints]
    for axis in measured:
        axis[seconds // 2 : seconds // 2 + 60] = np.nan
    aim = [np.where(up, angle, np.nan) for angle in (azimuth, elevation)]
    names = list(ActivityName)
    activity = np.where(up, names.index(ActivityName.TRACKING), names.index(ActivityName.HOLDING))
    corrections = [np.where(up, np.round(0.3 + share * 0.01, 3), 0.0) for share in (1.0, 2.0)]
    speeds = [np.where(up, np.round(chance.normal(0.0, 0.01, seconds), 3), 0.0) for _ in measured]
    weather = [np.round(4.0 + np.sin(elapsed_s / 900.0) + share, 1) for share in (1.0, 0.0)]
    light = np.where(up, np.round(1000.0 * np.sin(np.radians(elevation))), 0.0)
    beside = [*speeds, np.full(seconds, 24.0), *weather, light]
    columns = [elapsed_s, elapsed_s, azimuth, elevation, *aim, *setpoints, *measured, *corrections]
    columns += [*beside, activity]
    return Frames(np.column_stack(columns))


def _steps(angle_deg: NDArray[np.float64], up: NDArray[np.bool_]) -> NDArray[np.float64]:
    held, setpoint = float(angle_deg[0]), np.empty_like(angle_deg)
    for tick, (angle, is_up) in enumerate(zip(angle_deg.tolist(), up.tolist(), strict=True)):
        if is_up and abs(angle - held) > DEADBAND_DEG:
            held = angle
        setpoint[tick] = held
    return setpoint


def _followed(setpoint_deg: NDArray[np.float64]) -> NDArray[np.float64]:
    at, measured = float(setpoint_deg[0]), np.empty_like(setpoint_deg)
    for tick, setpoint in enumerate(setpoint_deg.tolist()):
        at += max(-SPEED_DPS, min(SPEED_DPS, (setpoint - at) * 0.8))
        measured[tick] = round(at / ENCODER_DEG) * ENCODER_DEG
    return measured
