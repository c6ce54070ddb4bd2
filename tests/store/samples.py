"""Domain objects with something in every field."""

from datetime import UTC, datetime, timedelta

from sqlalchemy import text

from app.store.connections import transaction, writing_engine
from app.sun.position import Location
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    HomeTrust,
    Pointing,
    Sighting,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.config import DriveConfig, DriveKind, Orientation, TrackerConfig
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.mode import Mode

NOON = datetime(2026, 6, 21, 9, 30, 15, 123456, tzinfo=UTC)
SAMSUN = Location(41.2867, 36.33, 4.0)
CONFIRMED = Confirmation(NOON, "Ayşe", 3)
SITE = SiteState(
    name="Samsun – test field",
    location=SAMSUN,
    location_revision=3,
    time_zone="Europe/Istanbul",
    clock=ClockSetting("manual", -12.5, NOON, "Ayşe"),
    confirmations={StepName.LOCATION: CONFIRMED, StepName.CLOCK: CONFIRMED},
)


def tracker(tracker_id: str = "T1", name: str = "Tracker 1") -> TrackerState:
    config = TrackerConfig(
        tracker_id, name, drive=DriveConfig(DriveKind.MODBUS_TCP, "simulated-plc", "10.0.0.7", 502, 3)
    )
    memory = TrackerMemory(
        mode=Mode.AZIMUTH,
        orientation=Orientation(180.0, 35.25),
        tracking_on=True,
        home=HomeTrust(NOON, "Ayşe", "zero set by hand", 7),
        showing="show-1",
        fault_code="following_error",
        fault_text="The azimuth axis does not follow: 2.1 degrees.",
        confirmations={StepName.HOMING: CONFIRMED},
        sightings=(Sighting(NOON, 179.5, 71.9, 179.0, 72.0),),
        pointing=Pointing(0.5, -0.1, 0.01, 0.02, 0.03),
    )
    return TrackerState(config, memory)


def plan(show_id: str = "show-1") -> ShowPlan:
    return ShowPlan(show_id, NOON, NOON + timedelta(hours=6), timedelta(seconds=180.5), SAMSUN)


def event(
    number: int = 0, *, kind: EventKind = EventKind.STEP_CONFIRMED, tracker_id: str | None = "T1"
) -> Event:
    data = {"step": "homing", "number": number, "nested": {"angles_deg": [1.5, None]}}
    return Event(NOON + timedelta(seconds=number), kind, tracker_id, f"Event {number}.", "Ayşe", data)


def execute(url: str, statement: str) -> object:
    """Run one statement on a database; return the first value that it found."""
    engine = writing_engine(url)
    try:
        with transaction(engine) as connection:
            done = connection.execute(text(statement))
            return done.scalar_one_or_none() if done.returns_rows else None
    finally:
        engine.dispose()
