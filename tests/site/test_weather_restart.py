"""The last wind outlives a kill: written at once where it matters, seldom where it does not."""

import asyncio
import threading
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field, replace
from datetime import timedelta
from pathlib import Path

import pytest

from app.base.twins import Twins
from app.link.weather_orders import ReportWeather, SimulateWeather
from app.simulation.simulated import SimulatedDrive
from app.site.site import SiteOptions
from app.site.weather import kept_weather
from app.site.weather.kept_weather import KeptWeather, WeatherFile
from app.tracker.commands.commands import Move
from app.tracker.memory.memory import ClockSetting, SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.protections import ProtectionConfig, WindProtection
from app.tracker.weather.simulated_weather import Scenario, SimulatedStation
from app.tracker.weather.weather import Quality, Weather, WeatherNow
from tests.fault_result import BY_ITSELF, FaultResult
from tests.patience import PATIENCE_S
from tests.site.plant import SAMSUN, SUMMER_NOON, Begun, Plant, make_plant, settle
from tests.site.tracking_field import homed

PLACED = SiteState("Storm", SAMSUN, 1, "Europe/Istanbul", ClockSetting("system"))


def limited(name: str, gust_mps: float) -> TrackerState:
    protection = ProtectionConfig(WindProtection(gust_mps=gust_mps, mean_mps=60.0))
    return TrackerState(replace(TrackerConfig(name, name), protection=protection), TrackerMemory())


TRACKERS = (limited("T1", 17.0), limited("T2", 20.0))


@dataclass
class Lives:
    """A site in one data folder, killed and started again; every file it wrote is counted."""

    folder: Path
    state: SiteState = PLACED
    at_s: float = 0.0
    plants: list[Plant] = field(default_factory=list)
    others: set["asyncio.Task[object]"] = field(default_factory=set)

    @property
    def file(self) -> Path:
        return self.folder / "weather"

    async def begin(self) -> Plant:
        """Begin another life, as long after the first one began as time has passed."""
        self.others = asyncio.all_tasks()
        options = SiteOptions(weather_file=self.file)
        start = SUMMER_NOON + timedelta(seconds=self.at_s)
        plant = make_plant(start=start, trackers=TRACKERS, state=self.state, options=options)
        self.plants.append(plant)
        await plant.start()
        return plant

    async def kill(self, *, down_s: float = 3.0) -> None:
        """End a life at once: nothing that it would do at its end is done."""
        for task in asyncio.all_tasks() - self.others - {asyncio.current_task()}:
            task.cancel()
        await settle()
        gone = self.plants[-1].clock.now() - SUMMER_NOON
        self.at_s = gone.total_seconds() + down_s


@pytest.fixture
async def lives(tmp_path: Path) -> AsyncIterator[Lives]:
    made = Lives(tmp_path)
    yield made
    await made.kill()


@pytest.fixture
def writes(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Return what was written to the file, in order."""
    written: list[bytes] = []
    write: Callable[[Twins, int, bytes], None] = Twins.write

    def counted(self: Twins, number: int, content: bytes) -> None:
        written.append(content)
        write(self, number, content)

    monkeypatch.setattr(kept_weather.Twins, "write", counted)
    return written


def told(plant: Plant) -> WeatherNow:
    weather = plant.latest().weather
    assert weather is not None
    return weather


def stows(plant: Plant) -> list[bool]:
    """Return which trackers the weather wants stowed."""
    return [plant.tracker(state.config.tracker_id).protection is not None for state in TRACKERS]


async def blow(plant: Plant, wind_mps: float) -> None:
    await plant.ask(ReportWeather(Weather(wind_mps=wind_mps, irradiance_wm2=700.0)), None)


@pytest.mark.fault(81)
async def test_a_storm_reported_just_before_a_kill_holds_afterwards(lives: Lives, fault: FaultResult) -> None:
    plant = await lives.begin()
    await blow(plant, 4.0)
    await blow(plant, 18.5)
    await lives.kill(down_s=7.0)
    plant = await lives.begin()
    await plant.forward(seconds=0.5)
    assert stows(plant) == [True, False]
    seen = told(plant)
    assert (seen.before_restart, seen.stale, seen.usable, seen.source) == (True, True, None, "technician")
    assert (seen.readings.wind_mps, seen.readings.irradiance_wm2) == (18.5, 700.0)
    assert seen.age_s == pytest.approx(7.5, abs=0.3)
    assert {one.quality for one in seen.quantities.values()} == {Quality.BEFORE_RESTART}
    fault.recovers(f"{BY_ITSELF} once the wind has been heard calm for the whole delay")


async def test_kills_in_a_row_forget_nothing_until_a_report_takes_its_place(lives: Lives) -> None:
    await blow(await lives.begin(), 18.5)
    for _ in range(3):
        await lives.kill()
        plant = await lives.begin()
        await plant.forward(seconds=0.5)
    assert stows(plant) == [True, False]
    assert told(plant).age_s == pytest.approx(10.5, abs=0.5)
    await blow(plant, 5.0)
    seen = told(plant)
    assert (seen.before_restart, seen.stale, seen.readings.wind_mps) == (False, False, 5.0)


@pytest.mark.fault(81)
async def test_a_station_that_stays_silent_over_many_lives_is_bad_after_its_time(lives: Lives) -> None:
    """What is heard begins its time anew; a restart does not."""
    plant = await lives.begin()
    await plant.forward(seconds=5.0)
    await blow(plant, 4.0)
    for _ in range(3):
        await lives.kill(down_s=1.0)
        plant = await lives.begin()
        await plant.forward(seconds=18.0)
        assert stows(plant) == [False, False]
    await lives.kill(down_s=1.0)
    plant = await lives.begin()
    await plant.forward(seconds=6.0)
    assert stows(plant) == [True, True]


@pytest.mark.parametrize(
    ("samples_every_s", "written"),
    [(None, [0, 600, 1200]), (300, [0, 307, 607, 907, 1207]), (1, [0, 240, 480, 720, 960, 1200])],
)
async def test_calm_weather_is_written_seldom_and_with_the_samples(
    tmp_path: Path, writes: list[bytes], samples_every_s: int | None, written: list[int]
) -> None:
    file, written_at = WeatherFile(tmp_path / "weather"), []
    for second in range(1260):
        now, samples_at = SUMMER_NOON + timedelta(seconds=second), None
        if samples_every_s is not None and second >= samples_every_s + 7:
            last = (second - 7) // samples_every_s * samples_every_s + 7
            samples_at = SUMMER_NOON + timedelta(seconds=last)
        before = len(writes)
        file.keep(KeptWeather(now, "plc", gust_mps=4.0), now, (), samples_at)
        if len(writes) > before:
            written_at.append(second)
    await file.written()
    assert written_at == written


async def test_gusts_about_a_limit_are_written_once(lives: Lives, writes: list[bytes]) -> None:
    plant = await lives.begin()
    for second in range(60):
        await blow(plant, 15.0 if second % 2 else 18.0)
        plant.clock.advance(timedelta(seconds=1))
    assert len(writes) == 1
    await blow(plant, 20.0)
    assert len(writes) == 2, "the limit of another tracker"
    assert lives.file.stat().st_size < 40_000


async def test_a_report_that_demands_a_stow_is_on_disk_once_it_is_acknowledged(
    lives: Lives, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[bytes] = []
    sync = Twins.sync

    def counted(self: Twins) -> None:
        sync(self)
        synced.append(lives.file.read_bytes())

    monkeypatch.setattr(kept_weather.Twins, "sync", counted)
    plant = await lives.begin()
    await blow(plant, 4.0)
    await blow(plant, 28.0)
    assert b'"gust_mps":28.0' in synced[-1]


async def test_a_proper_end_keeps_the_last_that_was_known(lives: Lives) -> None:
    plant = await lives.begin()
    for wind_mps in (4.0, 5.0, 6.0):
        await blow(plant, wind_mps)
    await plant.close()
    await lives.kill()
    plant = await lives.begin()
    await plant.forward(seconds=0.5)
    assert told(plant).readings.wind_mps == 6.0


@pytest.mark.fault(84)
@pytest.mark.parametrize("damage", [b"", b"\xff" * 300, b"{}"])
async def test_a_damaged_file_is_no_weather(lives: Lives, damage: bytes, fault: FaultResult) -> None:
    twins = Twins(lives.file, kept_weather.ROOM)
    twins.write(0, damage)
    plant = await lives.begin()
    await plant.forward(seconds=0.5)
    seen = plant.latest()
    assert seen.weather is None
    await blow(plant, 28.0)
    await plant.forward(seconds=0.5)
    assert stows(plant) == [True, True]
    fault.prevented("the copy before it is read; where both are damaged nothing is believed")
    fault.shows_nothing("as long as no weather is heard, none is shown")
    fault.recovers("automatic: with the next report")


async def test_a_disk_that_fails_keeps_no_report_from_acting(
    lives: Lives, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(kept_weather.Twins, "write", refuse)
    plant = await lives.begin()
    await blow(plant, 28.0)
    await plant.forward(seconds=0.5)
    assert stows(plant) == [True, True]


async def test_measured_weather_comes_back_when_a_simulation_ends(lives: Lives) -> None:
    plant = await lives.begin()
    await blow(plant, 6.0)
    await plant.ask(SimulateWeather(SimulatedStation(Scenario.STORM)), None)
    await plant.forward(seconds=2)
    assert told(plant).simulated
    await plant.ask(SimulateWeather(None), None)
    seen = told(plant)
    assert (seen.simulated, seen.readings.wind_mps) == (False, 6.0)
    assert seen.age_s == pytest.approx(2.0, abs=0.2)


async def test_simulated_weather_is_marked_so_after_a_kill_and_hides_no_measured_one(lives: Lives) -> None:
    plant = await lives.begin()
    await blow(plant, 6.0)
    await plant.ask(SimulateWeather(SimulatedStation(Scenario.STORM)), None)
    lives.state = plant.site.model.state
    await plant.forward(seconds=2)
    await lives.kill()
    plant = await lives.begin()
    await plant.forward(seconds=1)
    assert (told(plant).simulated, told(plant).before_restart) == (True, False)
    await plant.ask(SimulateWeather(None), None)
    seen = told(plant)
    assert (seen.simulated, seen.before_restart, seen.readings.wind_mps) == (False, True, 6.0)


async def test_a_file_that_cannot_be_read_or_written_keeps_no_controller_from_starting(lives: Lives) -> None:
    lives.file.mkdir()
    plant = await lives.begin()
    await blow(plant, 18.5)
    await plant.forward(seconds=0.5)
    assert stows(plant) == [True, False]


async def test_a_disk_that_hangs_at_the_end_does_not_keep_a_drive_turning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, begun: Begun
) -> None:
    plant = await begun(homed(options=SiteOptions(weather_file=tmp_path / "weather")))
    drive = plant.drives["T1"]
    assert isinstance(drive, SimulatedDrive)
    for wind_mps in (3.0, 4.0):
        await blow(plant, wind_mps)
    await plant.ask(Move(Orientation(200.0, 40.0)))
    await plant.forward(seconds=3.0)
    goes_on = threading.Event()
    monkeypatch.setattr(kept_weather.Twins, "sync", lambda _: goes_on.wait(PATIENCE_S))
    closing = asyncio.create_task(plant.site.close())
    await plant.forward(seconds=5.0)
    assert not closing.done()
    before = drive.true_orientation
    await plant.forward(seconds=1.0)
    assert drive.true_orientation == before
    goes_on.set()
    await closing
