"""A simulated day with weather: the tracker stows and comes back, as the site's own would."""

from datetime import UTC, datetime, timedelta

from app.show.simulate import simulate
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import Frames
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from app.tracker.weather.weather_day import WeatherDay, read_steps, stepped_day

SAMSUN = Location(41.2867, 36.33, 4.0)
MIDNIGHT = datetime(2026, 6, 21, tzinfo=UTC)
NINE = MIDNIGHT + timedelta(hours=9)
STEPS = "time,wind_mps,snow_kg\n09:00,3,0\n09:10,22,\n09:12,3,\n09:40,,6\n09:45,,0"


def simulated(weather: WeatherDay | None) -> Frames:
    _, frames = simulate(
        TrackerConfig("T1", "North"), Pointing(), SAMSUN, "UTC", Mode.DUAL, Orientation(180.0, 45.0),
        NINE, NINE + timedelta(hours=1), weather=weather,
    )  # fmt: skip
    return frames


def doing(frames: Frames) -> list[tuple[int, ActivityName]]:
    """Return from which second on the tracker did what."""
    found: list[tuple[int, ActivityName]] = []
    for second, index in enumerate(frames.column("activity")):
        name = list(ActivityName)[int(index)]
        if not found or found[-1][1] is not name:
            found.append((second, name))
    return found


def test_a_gust_stows_at_once_and_ten_calm_minutes_bring_it_back_and_snow_tips_after_a_minute() -> None:
    frames = simulated(stepped_day(read_steps(STEPS), MIDNIGHT, UTC))
    names = [name for _, name in doing(frames)]
    stow = [ActivityName.STOWING, ActivityName.STOWED]
    assert names == [ActivityName.TRACKING, *stow, ActivityName.TRACKING, *stow, ActivityName.TRACKING]
    began, _, back, tipped = (second for second, _ in doing(frames)[1:5])
    assert 600 <= began <= 602, "at the first gust"
    assert 720 + 600 <= back <= 720 + 720, "more than ten minutes after the last of the mean above its limit"
    assert 2399 + 60 <= tipped <= 2399 + 62, "a minute after the last look without snow"
    level = frames.column("measured_elevation_deg")[began + 60]
    upright = frames.column("measured_elevation_deg")[tipped + 60]
    assert round(float(level)) == 90
    assert round(float(upright)) == 0


def test_a_day_without_weather_has_no_stow() -> None:
    assert [name for _, name in doing(simulated(None))] == [ActivityName.TRACKING]
