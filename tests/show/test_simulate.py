"""Simulated days and shows: the sun they record is right, and the panel keeps to it."""

from datetime import UTC, date, datetime, time, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from app.show import simulate as simulating
from app.show.simulate import encoded, simulate, simulate_date, simulate_show
from app.sun.position import Location, sun_position
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import Frames
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.amount import SOAK, amount

SAMSUN = Location(41.2867, 36.33, 4.0)
ACTIVITIES = list(ActivityName)
HALF_TURN_EACH_WAY = AxisConfig(-180.0, 180.0, 6.0, 6.0, 0.5, 3.0)
NAIVE = datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None)
SITES = {
    "Samsun": (SAMSUN, "Europe/Istanbul", date(2026, 6, 21), TrackerConfig("T1", "North")),
    "Adelaide": (
        Location(-34.9, 138.6),
        "Australia/Adelaide",
        date(2026, 12, 21),
        TrackerConfig("T1", "South", azimuth=HALF_TURN_EACH_WAY),
    ),
    "Reykjavik": (
        Location(64.1, -21.9),
        "Atlantic/Reykjavik",
        date(2026, 3, 21),
        TrackerConfig("T1", "North"),
    ),
    "Nairobi": (
        Location(-1.3, 36.8),
        "Africa/Nairobi",
        date(2026, 9, 23),
        TrackerConfig("T1", "Line", azimuth=HALF_TURN_EACH_WAY),
    ),
}
AT_SITES = pytest.mark.parametrize("site", amount(["Samsun"], [*SITES]))
HELD = Orientation(180.0, 45.0)
BEGIN = datetime(2026, 6, 21, 8, tzinfo=UTC)


def frames_of(
    config: TrackerConfig, begin: datetime, end: datetime, step_s: float = 1.0, mode: Mode = Mode.DUAL
) -> Frames:
    """Return what a simulation at Samsun recorded."""
    step = timedelta(seconds=step_s)
    _, frames = simulate(config, Pointing(), SAMSUN, "Europe/Istanbul", mode, HELD, begin, end, step=step)
    return frames


def off_the_sun_deg(frames: Frames) -> np.ndarray:
    """Return how far the panel is off the sun."""
    a = np.radians(frames.column("measured_elevation_deg"))
    b = np.radians(frames.column("sun_elevation_deg"))
    half = np.radians(frames.column("measured_azimuth_deg") - frames.column("sun_azimuth_deg")) / 2
    way = np.sin((a - b) / 2) ** 2 + np.cos(a) * np.cos(b) * np.sin(half) ** 2
    return 2 * np.degrees(np.arcsin(np.minimum(1.0, np.sqrt(way))))


def simulated(config: TrackerConfig, location: Location, zone: str, day: date) -> Frames:
    """Return the hours about sunrise, in the soak the whole day."""
    if SOAK:
        return simulate_date(config, location, zone, day)[1]
    begin = datetime.combine(day, time(4), ZoneInfo(zone))
    end = begin + timedelta(hours=4)
    return simulate(config, Pointing(), location, zone, Mode.DUAL, HELD, begin, end)[1]


@AT_SITES
def test_the_panel_keeps_within_the_deadband_of_the_sun_all_day(site: str) -> None:
    location, zone, day, config = SITES[site]
    frames = simulated(config, location, zone, day)
    up = frames.column("sun_elevation_deg") > 0.5

    assert up.sum() > amount(2, 9) * 3600
    assert set(frames.column("activity")) == {ACTIVITIES.index(ActivityName.TRACKING)}
    assert off_the_sun_deg(frames)[up].max() <= config.deadband_deg


def test_the_recorded_sun_is_that_of_its_instants() -> None:
    frames = frames_of(TrackerConfig("T1", "Plain"), BEGIN, BEGIN + timedelta(minutes=10), step_s=60.0)
    for at_s, azimuth_deg, elevation_deg in zip(
        *(frames.column(name) for name in ("sun_time_s", "sun_azimuth_deg", "sun_elevation_deg")), strict=True
    ):
        sun = sun_position(TrackerConfig("T1", "Plain").algorithm, SAMSUN, BEGIN + timedelta(seconds=at_s))
        assert azimuth_deg == pytest.approx(sun.azimuth_deg, abs=1e-3)
        assert elevation_deg == pytest.approx(sun.apparent_elevation_deg, abs=1e-3)


def test_a_civil_day_has_the_hours_that_its_clocks_show(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[datetime] = []
    monkeypatch.setattr(simulating, "simulate", lambda *given, **_: asked.extend(given[6:8]))
    simulate_date(TrackerConfig("T1", "DST"), Location(52.5, 13.4), "Europe/Berlin", date(2026, 3, 29))
    begin, end = (at.astimezone(UTC) for at in asked)
    assert end - begin == timedelta(hours=23)


@pytest.mark.parametrize("night", list(NightBehaviour))
def test_the_night_ends_at_the_sun(night: NightBehaviour) -> None:
    config = TrackerConfig("T1", "Night", night=night)
    end = datetime(2026, 6, 22, 4, tzinfo=UTC)
    frames = frames_of(config, end - timedelta(hours=amount(2.5, 12)), end, step_s=5.0)
    assert off_the_sun_deg(frames)[-1] <= config.deadband_deg


def test_a_fixed_panel_stands_still_while_the_sun_goes_on() -> None:
    end = BEGIN + timedelta(minutes=30)
    frames = frames_of(TrackerConfig("T1", "Fixed"), BEGIN, end, mode=Mode.FIXED)

    assert np.ptp(frames.column("measured_azimuth_deg")) == 0.0
    assert frames.column("measured_azimuth_deg")[0] == pytest.approx(HELD.azimuth_deg, abs=0.05)
    assert np.ptp(frames.column("sun_azimuth_deg")) > 5.0


def show(minutes: float) -> ShowPlan:
    return ShowPlan(
        "solstice",
        datetime(2026, 6, 21, 2, 10, tzinfo=UTC),
        datetime(2026, 6, 21, 17, 20, tzinfo=UTC),
        timedelta(minutes=minutes),
        SAMSUN,
    )


def test_the_solstice_in_three_minutes() -> None:
    info, frames = simulate_show(TrackerConfig("T1", "Show"), Pointing(), "Europe/Istanbul", show(3))

    assert info.duration_s == pytest.approx(180.0, abs=0.2)
    assert frames.column("sun_time_s")[-1] == pytest.approx(
        info.sun_end.timestamp() - info.sun_start.timestamp(), abs=60.0
    )
    assert np.all(np.diff(frames.column("sun_time_s")) >= 0.0)
    assert set(frames.column("activity")) == {ACTIVITIES.index(ActivityName.SHOWING)}


def test_a_show_too_fast_for_the_axes_is_refused() -> None:
    with pytest.raises(CommandRejected):
        simulate_show(TrackerConfig("T1", "Show"), Pointing(), "UTC", show(0.25))


def test_frames_survive_the_store_s_encoding() -> None:
    frames = frames_of(TrackerConfig("T1", "Short"), BEGIN, BEGIN + timedelta(minutes=20))

    assert len(encoded(frames)) >= 2
    assert all(isinstance(chunk, str) for chunk in encoded(frames))


@pytest.mark.parametrize(
    ("begin", "end", "step", "message"),
    [
        (NAIVE, NAIVE + timedelta(days=1), 1.0, "time zone"),
        (datetime(2026, 1, 2, tzinfo=UTC), datetime(2026, 1, 1, tzinfo=UTC), 1.0, "must end after it starts"),
        (datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 1, 2, tzinfo=UTC), 0.01, "step"),
        (datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 1, 4, tzinfo=UTC), 0.2, "longer step"),
    ],
    ids=["naive", "backwards", "too fine", "too many"],
)
def test_a_span_that_cannot_be_simulated_is_refused(
    begin: datetime, end: datetime, step: float, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        frames_of(TrackerConfig("T1", "Wrong"), begin, end, step)
