"""Simulated days and shows: the sun they record is right, and the panel keeps to it."""

from datetime import UTC, date, datetime, time, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pandas as pd
import pvlib
import pytest

from app.show import simulate as simulating
from app.show.simulate import encoded, simulate, simulate_date, simulate_show
from app.sun.position import Algorithm, Location
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import Frames, RecordingInfo
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.amount import SOAK, amount

SAMSUN = Location(41.2867, 36.33, 4.0)
ACTIVITIES = list(ActivityName)
SUN_LIMIT_DEG = 0.01
HALF_TURN_EACH_WAY = AxisConfig(-180.0, 180.0, 6.0, 6.0, 0.5, 3.0)
NAIVE = datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None)
SITES = [
    pytest.param(SAMSUN, "Europe/Istanbul", date(2026, 6, 21), TrackerConfig("T1", "North"), id="Samsun"),
    pytest.param(
        Location(-34.9, 138.6),
        "Australia/Adelaide",
        date(2026, 12, 21),
        TrackerConfig("T1", "South", azimuth=HALF_TURN_EACH_WAY),
        id="Adelaide",
    ),
    pytest.param(
        Location(64.1, -21.9),
        "Atlantic/Reykjavik",
        date(2026, 3, 21),
        TrackerConfig("T1", "North"),
        id="Reykjavik",
    ),
    pytest.param(
        Location(-1.3, 36.8),
        "Africa/Nairobi",
        date(2026, 9, 23),
        TrackerConfig("T1", "Line", azimuth=HALF_TURN_EACH_WAY),
        id="Nairobi",
    ),
]


def separation(a_az: np.ndarray, a_el: np.ndarray, b_az: np.ndarray, b_el: np.ndarray) -> np.ndarray:
    a, b = np.radians(a_el), np.radians(b_el)
    half = np.radians(a_az - b_az) / 2
    return 2 * np.degrees(
        np.arcsin(
            np.minimum(1.0, np.sqrt(np.sin((a - b) / 2) ** 2 + np.cos(a) * np.cos(b) * np.sin(half) ** 2))
        )
    )


def spa(info: RecordingInfo, frames: Frames) -> tuple[np.ndarray, np.ndarray]:
    """Return azimuth and true elevation by NREL's SPA, as pvlib computes it."""
    at = pd.to_datetime(info.sun_start.timestamp() + frames.column("sun_time_s"), unit="s", utc=True)
    found = pvlib.solarposition.get_solarposition(
        at,
        info.location.latitude_deg,
        info.location.longitude_deg,
        altitude=info.location.altitude_m,
        method="nrel_numpy",
    )
    return found["azimuth"].to_numpy(), found["elevation"].to_numpy()


def simulated(
    config: TrackerConfig, location: Location, zone: str, day: date, step: timedelta = timedelta(seconds=1)
) -> tuple[RecordingInfo, Frames]:
    """Return the hours about sunrise, in the soak the whole day."""
    if SOAK:
        return simulate_date(config, location, zone, day, step=step)
    begin = datetime.combine(day, time(4), ZoneInfo(zone))
    held = Orientation(180.0, 45.0)
    end = begin + timedelta(hours=5)
    return simulate(config, Pointing(), location, zone, Mode.DUAL, held, begin, end, step=step)


@pytest.mark.parametrize(("location", "zone", "day", "config"), amount(SITES[::3], SITES))
def test_the_panel_keeps_within_the_deadband_of_the_sun_all_day(
    location: Location, zone: str, day: date, config: TrackerConfig
) -> None:
    _, frames = simulated(config, location, zone, day)
    up = frames.column("sun_elevation_deg") > 0.5

    off_deg = separation(
        frames.column("measured_azimuth_deg")[up],
        frames.column("measured_elevation_deg")[up],
        frames.column("sun_azimuth_deg")[up],
        frames.column("sun_elevation_deg")[up],
    )

    assert up.sum() > amount(2, 9) * 3600
    assert set(frames.column("activity")) == {ACTIVITIES.index(ActivityName.TRACKING)}
    assert off_deg.max() <= config.deadband_deg


@pytest.mark.parametrize(("location", "zone", "day", "config"), SITES)
def test_the_recorded_sun_is_nrel_s(location: Location, zone: str, day: date, config: TrackerConfig) -> None:
    plain = TrackerConfig("T1", "Plain", azimuth=config.azimuth, refraction=False)
    info, frames = simulated(plain, location, zone, day, step=timedelta(seconds=60))
    azimuth_deg, elevation_deg = spa(info, frames)

    off_deg = separation(
        frames.column("sun_azimuth_deg"), frames.column("sun_elevation_deg"), azimuth_deg, elevation_deg
    )

    assert off_deg.max() < SUN_LIMIT_DEG


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

    _, frames = simulate(
        config,
        Pointing(),
        SAMSUN,
        "Europe/Istanbul",
        Mode.DUAL,
        Orientation(180.0, 45.0),
        end - timedelta(hours=amount(4, 12)),
        end,
        step=timedelta(seconds=5),
    )

    last = frames.values[-1]
    assert separation(last[8], last[9], last[2], last[3]) <= config.deadband_deg


def test_a_fixed_panel_stands_still_while_the_sun_goes_on() -> None:
    held = Orientation(150.0, 30.0)
    begin = datetime(2026, 6, 21, 8, tzinfo=UTC)

    _, frames = simulate(
        TrackerConfig("T1", "Fixed"),
        Pointing(),
        SAMSUN,
        "UTC",
        Mode.FIXED,
        held,
        begin,
        begin + timedelta(hours=1),
    )

    assert np.ptp(frames.column("measured_azimuth_deg")) == 0.0
    assert frames.column("measured_azimuth_deg")[0] == pytest.approx(held.azimuth_deg, abs=0.05)
    assert np.ptp(frames.column("sun_azimuth_deg")) > 10.0


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
    begin = datetime(2026, 6, 21, 8, tzinfo=UTC)
    _, frames = simulate(
        TrackerConfig("T1", "Short"),
        Pointing(),
        SAMSUN,
        "UTC",
        Mode.DUAL,
        Orientation(0.0, 0.0),
        begin,
        begin + timedelta(minutes=20),
    )

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
        simulate(
            TrackerConfig("T1", "Wrong"),
            Pointing(),
            SAMSUN,
            "UTC",
            Mode.DUAL,
            Orientation(0.0, 0.0),
            begin,
            end,
            step=timedelta(seconds=step),
        )


def test_algorithms_agree_on_the_day() -> None:
    days = [
        simulated(
            TrackerConfig("T1", "Any", algorithm=algorithm),
            SAMSUN,
            "UTC",
            date(2026, 6, 21),
            step=timedelta(seconds=60),
        )[1]
        for algorithm in (Algorithm.PSA, Algorithm.KOBLICK, Algorithm.SPA)
    ]

    for other in days[1:]:
        apart_deg = np.abs(days[0].column("sun_elevation_deg") - other.column("sun_elevation_deg"))
        assert 0.0 < apart_deg.max() < 0.03
