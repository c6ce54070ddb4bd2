"""Plausible stored data for tests that need a machine or a store but not the real one."""

from datetime import UTC, datetime, timedelta
from math import cos, pi, sin

import numpy as np

from app.base.message import N_
from app.sun.position import Location, SunPosition
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    HomeTrust,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode

SAMSUN = Location(41.2867, 36.33, 4.0)
TIME_ZONE = "Europe/Istanbul"
NOON = datetime(2026, 6, 21, 9, 30, tzinfo=UTC)
COMMISSIONED_AT = datetime(2026, 6, 20, 8, 0, tzinfo=UTC)
HELD = Orientation(180.0, 45.0)


def made_up_sun(at: datetime) -> SunPosition:
    """Return a sun that goes round once a day and stands in the south at 09:30 UTC."""
    turn = 2 * pi * ((at - NOON) / timedelta(days=1))
    elevation_deg = 10.0 + 60.0 * cos(turn)
    return SunPosition((180.0 + turn * 180.0 / pi) % 360.0, elevation_deg, elevation_deg + 0.01)


def site_state() -> SiteState:
    """Return a site in Samsun whose location and clock are confirmed."""
    confirmed = {
        step: Confirmation(COMMISSIONED_AT, "operator", 1) for step in (StepName.LOCATION, StepName.CLOCK)
    }
    return SiteState(
        name="Samsun solar field",
        location=SAMSUN,
        location_revision=1,
        time_zone=TIME_ZONE,
        clock=ClockSetting("system", 0.0, COMMISSIONED_AT, "operator"),
        confirmations=confirmed,
    )


def commissioned(tracker_id: str, name: str, *, tracking: bool) -> TrackerState:
    """Return a tracker that has been homed and given the dual-axis mode."""
    steps = (StepName.HOMING, StepName.MODE, StepName.RUN) if tracking else (StepName.HOMING, StepName.MODE)
    memory = TrackerMemory(
        mode=Mode.DUAL,
        orientation=HELD,
        tracking_on=tracking,
        home=HomeTrust(COMMISSIONED_AT, "operator", N_("set manually"), 3),
        confirmations={step: Confirmation(COMMISSIONED_AT, "operator", 1) for step in steps},
    )
    return TrackerState(TrackerConfig(tracker_id, name), memory)


def recording(
    recording_id: str, kind: RecordingKind, title: str, hours: float, duration_s: float
) -> RecordingInfo:
    """Return the head of a finished recording of T1 around noon."""
    begin = NOON - timedelta(hours=hours / 2)
    return RecordingInfo(
        recording_id=recording_id,
        kind=kind,
        tracker_id="T1",
        tracker_name="North field",
        title=title,
        began_at=COMMISSIONED_AT,
        sun_start=begin,
        sun_end=begin + timedelta(hours=hours),
        duration_s=duration_s,
        location=SAMSUN,
        time_zone=TIME_ZONE,
        mode=Mode.DUAL,
        held_azimuth_deg=HELD.azimuth_deg,
        held_elevation_deg=HELD.elevation_deg,
        algorithm="psa",
        drive="Simulated drive",
        ended_at=COMMISSIONED_AT + timedelta(seconds=duration_s),
        outcome="completed",
        sample_count=len(frame_times(duration_s)),
    )


def frame_times(duration_s: float) -> np.ndarray:
    """Return when frames were taken: ten a second for a show, one a second for a day."""
    return np.arange(0.0, duration_s, 0.1 if duration_s < 3600 else 1.0)


def frames(info: RecordingInfo) -> Frames:
    """Return frames in which the panel follows the made-up sun a little behind."""
    elapsed_s = frame_times(info.duration_s)
    sun_span_s = (info.sun_end - info.sun_start).total_seconds()
    sun_time_s = elapsed_s * sun_span_s / info.duration_s
    turn = 2 * pi * (sun_time_s - sun_span_s / 2) / 86400.0
    azimuth = (180.0 + np.degrees(turn)) % 360.0
    elevation = 10.0 + 60.0 * np.cos(turn)
    measured = elevation - 0.02 + 0.01 * sin(1.0)
    columns = (
        elapsed_s, sun_time_s, azimuth, elevation, azimuth, elevation,
        azimuth, elevation, azimuth - 0.05, measured, np.zeros_like(elapsed_s), np.zeros_like(elapsed_s),
        np.full_like(elapsed_s, 0.25), np.zeros_like(elapsed_s), np.full_like(elapsed_s, 24.1),
        6.0 + 2.0 * np.sin(elapsed_s / 7.0), np.full_like(elapsed_s, 6.0), np.full_like(elapsed_s, np.nan),
        np.full_like(elapsed_s, 6.0),
    )  # fmt: skip
    assert len(columns) == len(COLUMNS)
    return Frames(np.column_stack(columns))
