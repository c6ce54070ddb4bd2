"""The controller killed in a storm: every tracker whose home position holds stows by itself afterwards."""

import asyncio
import os
import random
import shutil
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from pathlib import Path
from uuid import uuid4

import pytest

from app.link.messages import MachineUnreachable, SiteCommand
from app.link.weather_orders import ReportWeather
from app.tracker.commands.commands import Command, GoToStart, Jog, Park, RunShow, Stop
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import DriveKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, ShowPhase, SiteSnapshot, Snapshot
from app.tracker.weather.weather import Weather
from tests.e2e.product import DriveSim
from tests.fault_result import BY_ITSELF, REAL, FaultResult
from tests.machine.field import SHELTERED, Line, noon_place, prepare
from tests.machine.lives import Machine
from tests.soak.rigs.fieldwork import gateway

CALM, STORM = Weather(wind_mps=4.0), Weather(wind_mps=28.0)
STOWS_WITHIN_S = 5.0
LONGEST_COAST_S = 0.5 + 0.5 + 1.2
"""From what was last told of a drive to its rest: the pause between two publications, watchdog and ramp."""
USUAL = TrackerConfig("T", "T")
LATEST_KILL_S = {"before": 0.3, "during": 0.01, "after": 1.0}
"""When the controller is killed: before the wind is reported, while it is, or afterwards."""
AT_ONCE = 0.3
"""How often it is killed at the first instant."""


class Left(StrEnum):
    """What a tracker was left doing when the storm came."""

    TRACKING = "tracking"
    PARKED = "parked"
    SHOW = "running a show"
    STOPPED = "stopped by a person"
    JOGGED = "moved by hand"

    @property
    def by_itself(self) -> bool:
        """Return whether a storm moves it to its stow position, as without any restart."""
        return self not in (Left.STOPPED, Left.JOGGED)


@dataclass
class Storm:
    """Kills one field again and again, each time in a storm of its own; most of its trackers track."""

    folder: Path
    trackers: int
    line: Line
    dice: random.Random
    counted: Counter[str] = field(default_factory=Counter)
    slowest_s: float = 0.0
    text: str = ""

    def __post_init__(self) -> None:
        self.place, now = noon_place(datetime.now(UTC)), datetime.now(UTC)
        self.show = ShowPlan("noon", now, now + timedelta(minutes=90), timedelta(seconds=20), self.place)
        others = [one for one in Left if one is not Left.TRACKING]
        kinds = [Left.TRACKING] * (self.trackers - len(others)) + others
        self.lefts = {f"T{number}": left for number, left in enumerate(kinds, 1)}

    async def kill(self, number: int) -> None:
        """Live through one storm and one kill; fail if a tracker does not do what it has to."""
        machine = Machine.of(self.folder / f"storm-{number}")
        prepare(machine.data_dir, self.trackers, self.place, self.line)
        try:
            await self._kill(machine, [*LATEST_KILL_S][number % len(LATEST_KILL_S)])
        finally:
            await machine.stop()
            shutil.rmtree(machine.data_dir)

    async def _kill(self, machine: Machine, when: str) -> None:
        self.counted[when] += 1
        pressing = await self._begin(machine)
        before = machine.site
        acknowledged = await self._storm(machine, when)
        pressing.cancel()
        await asyncio.gather(pressing, return_exceptions=True)
        before = machine.link.latest() or before
        await machine.forget()
        at = time.monotonic()
        await machine.start()
        if not acknowledged:
            await machine.ask(ReportWeather(STORM))
        await machine.until_site(self._all_stow, "all stow", within_s=STOWS_WITHIN_S)
        self.slowest_s = max(self.slowest_s, time.monotonic() - at)
        assert time.monotonic() - at <= STOWS_WITHIN_S
        self._check(before, machine.site, acknowledged=acknowledged)

    async def _begin(self, machine: Machine) -> "asyncio.Task[None]":
        """Start it in calm weather, and have each tracker do what the storm finds it doing."""
        await machine.start()
        await _told(machine, ReportWeather(CALM))
        await machine.until_site(lambda seen: all(map(_is_read, seen.trackers)), "every drive is read")
        name = {left: name for name, left in self.lefts.items()}
        await _told(machine, Park(), name[Left.PARKED])
        await _told(machine, Stop(), name[Left.STOPPED])
        await _told(machine, Stop(), name[Left.JOGGED])
        await _told(machine, GoToStart(self.show), name[Left.SHOW])
        await machine.until_site(lambda seen: _is_ready(_one(seen, name[Left.SHOW])), "the show is ready")
        await _told(machine, RunShow(self.show), name[Left.SHOW])
        await machine.until_site(
            lambda seen: all(map(self._is_under_way, seen.trackers)), "all are under way"
        )
        press = Jog(uuid4().hex, Axis.AZIMUTH, 1, JogSpeed.SLOW)
        return asyncio.create_task(machine.hold(name[Left.JOGGED], press))

    def _is_under_way(self, seen: Snapshot) -> bool:
        doing = {Left.SHOW: ActivityName.SHOWING, Left.TRACKING: ActivityName.TRACKING}
        wanted = doing.get(self.lefts[seen.tracker_id])
        return wanted is None or seen.activity is wanted

    async def _storm(self, machine: Machine, when: str) -> bool:
        """Report the wind and kill; return whether the report was acknowledged."""
        reporting = asyncio.create_task(_told(machine, ReportWeather(STORM))) if when != "before" else None
        if when == "after" and reporting is not None:
            await reporting
        at_once = self.dice.random() < AT_ONCE
        await asyncio.sleep(0.0 if at_once else self.dice.uniform(0.0, LATEST_KILL_S[when]))
        machine.kill()
        return reporting is not None and await reporting

    def _all_stow(self, seen: SiteSnapshot) -> bool:
        """Return whether all stow, and every drive was read in this very snapshot: a late one is unknown."""
        return all(map(_is_read, seen.trackers)) and all(
            one.activity in SHELTERED for one in seen.trackers if self.lefts[one.tracker_id].by_itself
        )

    def _check(self, before: SiteSnapshot, after: SiteSnapshot, *, acknowledged: bool) -> None:
        """Fail if wind, home or place was forgotten, or if something moves that a person had stopped."""
        weather = after.weather
        assert weather is not None
        assert (weather.readings.wind_mps, weather.simulated) == (STORM.wind_mps, False)
        assert weather.before_restart is weather.stale
        assert weather.before_restart or not acknowledged
        assert weather.age_s <= STOWS_WITHIN_S + LATEST_KILL_S["after"]
        protection = _one(after, "T1").protection
        assert protection is not None
        self.text = protection.reason.message
        assert "The wind at Tracker 1" in self.text
        for one in after.trackers:
            left = self.lefts[one.tracker_id]
            assert one.homed, one
            assert left.by_itself or one.activity is ActivityName.HOLDING, one
            assert left.by_itself or one.protection is not None, one
            _check_place(_one(before, one.tracker_id), one)


def _check_place(before: Snapshot, after: Snapshot) -> None:
    """Fail if an axis stands farther from where it was seen last than it can have coasted."""
    places = zip(_places_deg(before), _places_deg(after), (USUAL.azimuth, USUAL.elevation), strict=True)
    for before_deg, after_deg, config in places:
        assert abs(after_deg - before_deg) <= config.speed_dps * LONGEST_COAST_S, (before, after)


def _is_read(seen: Snapshot) -> bool:
    return None not in _places_deg(seen)


def _places_deg(seen: Snapshot) -> tuple[float | None, float | None]:
    return tuple(None if axis is None else axis.position_deg for axis in (seen.azimuth, seen.elevation))


def _is_ready(seen: Snapshot) -> bool:
    return seen.show is not None and seen.show.phase is ShowPhase.READY


def _one(seen: SiteSnapshot, name: str) -> Snapshot:
    return next(one for one in seen.trackers if one.tracker_id == name)


async def _told(machine: Machine, command: Command | SiteCommand, tracker_id: str = "T1") -> bool:
    """Give an order once; return whether it was acknowledged. One answered too late is carried out, too."""
    with suppress(MachineUnreachable):
        await machine.ask(command, tracker_id)
        return True
    return False


KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "3"))
TRACKERS = int(os.environ.get("HELIOPANEL_TEST_TRACKERS", "12"))
SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "1"))
ON_A_DRIVE = 2


@pytest.fixture
def storm(tmp_path: Path) -> Iterator[Storm]:
    line = gateway(ON_A_DRIVE, tmp_path, DriveKind.MODBUS_TCP)
    prepare(tmp_path / "unused", 0, noon_place(datetime.now(UTC)), line)
    drive = DriveSim.start(line.drive.port, line.memory, ON_A_DRIVE)
    yield Storm(tmp_path, TRACKERS, line, random.Random(SEED))
    drive.stop()


@pytest.mark.timeout(60 + 30 * KILLS)
@pytest.mark.fault(80)
async def test_killed_in_a_storm_every_homed_tracker_stows_by_itself(
    storm: Storm, fault: FaultResult
) -> None:
    for number in range(KILLS):
        await storm.kill(number)
    fault.noticed(storm.slowest_s, REAL)
    fault.shows(storm.text)
    fault.recovers(f"{BY_ITSELF} once the wind has been calm for the set time")
    counted = ", ".join(f"{when} {times}" for when, times in sorted(storm.counted.items()))
    print(
        f"seed {SEED}: {KILLS} kills of {TRACKERS} trackers ({counted} the report), all stowing at most "
        f"{storm.slowest_s:.2f} s after the restart"
    )
