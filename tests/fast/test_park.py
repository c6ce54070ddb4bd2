"""The park's loop against the real controller on its simulated drive, tick by tick."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from app.fast.directions import directions
from app.fast.park import OUTSIDE, _columns, _judge_all, _judge_each, _law, park_day, trace
from app.show.simulate import simulate
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import COLUMNS
from app.tracker.settings.axes import AZIMUTH_DEFAULT
from app.tracker.settings.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from tests.amount import amount

SAMSUN, HELD = Location(41.2867, 36.33), Orientation(180.0, 45.0)
TRACKER = TrackerConfig("T1", "Tracker 1")
AZIMUTH, ELEVATION = COLUMNS.index("measured_azimuth_deg"), COLUMNS.index("measured_elevation_deg")


@dataclass(frozen=True)
class Day:
    """What is followed, where, from when and how long."""

    config: TrackerConfig
    location: Location
    begin: datetime
    hours: int = 24
    mode: Mode = Mode.DUAL
    pointing: Pointing = Pointing()


DAYS = {
    "solstice from midnight": Day(TRACKER, SAMSUN, datetime(2026, 6, 20, 21, tzinfo=UTC)),
    "offsets and a narrow deadband": Day(
        replace(TRACKER, deadband_deg=0.2),
        SAMSUN,
        datetime(2026, 3, 20, 4, tzinfo=UTC),
        6,
        pointing=Pointing(azimuth_offset_deg=1.3, elevation_offset_deg=-0.7),
    ),
    "through north, where the cable unwinds": Day(
        TRACKER, Location(-34.0, 18.4), datetime(2026, 12, 21, 8, tzinfo=UTC), 6
    ),
    "a tight range in polar day": Day(
        replace(TRACKER, azimuth=replace(AZIMUTH_DEFAULT, minimum_deg=40.0, maximum_deg=320.0)),
        Location(78.2, 15.6),
        datetime(2026, 6, 20, 21, tzinfo=UTC),
        8,
    ),
    "azimuth alone, parked at night": Day(
        replace(TRACKER, night=NightBehaviour.PARK),
        SAMSUN,
        datetime(2026, 12, 21, 13, tzinfo=UTC),
        6,
        Mode.AZIMUTH,
    ),
    "elevation alone, held at night": Day(
        replace(TRACKER, night=NightBehaviour.HOLD),
        SAMSUN,
        datetime(2026, 9, 23, 15, tzinfo=UTC),
        2,
        Mode.ELEVATION,
    ),
}


@pytest.mark.parametrize("day", DAYS.values(), ids=DAYS.keys())
def test_every_tick_reads_as_with_the_real_controller(day: Day) -> None:
    end = day.begin + timedelta(hours=amount(min(day.hours, 2), day.hours))
    _, frames = simulate(day.config, day.pointing, day.location, "UTC", day.mode, HELD, day.begin, end)
    at_unix_s = day.begin.timestamp() + np.arange(len(frames), dtype=np.float64)
    aims = directions(day.config, day.mode, HELD, day.location, at_unix_s)
    azimuth_deg, elevation_deg = trace(
        day.config,
        aims,
        azimuth_offset_deg=day.pointing.azimuth_offset_deg,
        elevation_offset_deg=day.pointing.elevation_offset_deg,
    )
    turned_deg = (frames.values[:, AZIMUTH] - azimuth_deg + 180.0) % 360.0 - 180.0
    assert np.abs(turned_deg).max() < 1e-9
    assert np.abs(frames.values[:, ELEVATION] - elevation_deg).max() < 1e-9


def test_a_block_is_judged_alike_with_and_without_a_compiler() -> None:
    config = replace(TRACKER, azimuth=replace(AZIMUTH_DEFAULT, minimum_deg=40.0, maximum_deg=320.0))
    at_unix_s = datetime(2026, 6, 21, tzinfo=UTC).timestamp() + np.arange(0.0, 86_400.0, 60.0)
    columns = _columns(directions(config, Mode.DUAL, HELD, SAMSUN, at_unix_s))
    laws = _law(config.azimuth), _law(config.elevation)
    flagged = set()
    for read_deg in ((180.0, 45.0), (40.0, 5.0), (318.0, 88.0)):
        each, all_ = np.full((2, at_unix_s.size), np.nan)
        numbers = [
            judge(columns, read_deg, (0.5, 1.3, -0.7), *laws, away)
            for judge, away in ((_judge_each, each), (_judge_all, all_))
        ]
        assert numbers[0] == numbers[1]
        assert np.abs(each - all_).max() < 1e-8
        flagged |= {bool(one) for one in each > OUTSIDE / 2.0}
    assert flagged == {False, True}


def test_a_park_sums_up_what_its_trackers_do_one_by_one() -> None:
    at_unix_s = datetime(2026, 6, 21, 3, tzinfo=UTC).timestamp() + np.arange(0.0, amount(3_600.0, 21_600.0))
    aims = directions(TRACKER, Mode.DUAL, HELD, SAMSUN, at_unix_s)
    deadbands_deg, offsets_deg = np.array([0.25, 0.5, 2.0]), np.array([0.0, 0.4, -1.1])
    day = park_day(
        TRACKER,
        aims,
        deadband_deg=deadbands_deg,
        azimuth_offset_deg=offsets_deg,
        elevation_offset_deg=-offsets_deg,
    )
    for k, deadband_deg in enumerate(deadbands_deg):
        config = replace(TRACKER, deadband_deg=float(deadband_deg))
        azimuth_deg, elevation_deg = trace(
            config, aims, azimuth_offset_deg=offsets_deg[k], elevation_offset_deg=-offsets_deg[k]
        )
        travelled_deg = np.abs(np.diff(azimuth_deg)).sum(), np.abs(np.diff(elevation_deg)).sum()
        assert day.azimuth_travel_deg[k] == pytest.approx(travelled_deg[0], abs=0.02)
        assert day.elevation_travel_deg[k] == pytest.approx(travelled_deg[1], abs=0.02)
        begun = np.flatnonzero(np.diff((np.diff(azimuth_deg) != 0).astype(int)) > 0).size
        assert abs(day.moves[k] - begun) <= 1
        assert 0.5 * deadband_deg < day.worst_off_deg[k] <= deadband_deg
        assert day.rms_off_deg[k] < day.worst_off_deg[k]
