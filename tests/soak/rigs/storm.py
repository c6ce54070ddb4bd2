"""A field of trackers in a storm whose controller is killed, and what every tracker has to do afterwards."""

import asyncio
import random
import shutil
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from pathlib import Path
from uuid import uuid4

from app.base.settings import Settings
from app.link.messages import MachineUnreachable, Order
from app.link.weather_orders import ReportWeather
from app.simulation.kept_positions import KeptPositions
from app.simulation.position_memory import AxisMemory, Memory, PositionFile, PositionMemory
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.tracker.commands.commands import GoToStart, Jog, RunShow
from app.tracker.memory.memory import (
    ClockSetting,
    Confirmation,
    HomeTrust,
    SiteState,
    StepName,
    TrackerMemory,
    TrackerState,
)
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, ShowPhase, SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.weather.weather import Weather
from tests.machine.lives import Machine
from tests.machine.service import SAMSUN
from tests.patience import eventually

NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
SHOW = ShowPlan("morning", NOON, NOON + timedelta(minutes=90), timedelta(seconds=20), SAMSUN)
CALM, STORM = Weather(wind_mps=4.0), Weather(wind_mps=28.0)
STOWS_WITHIN_S = 5.0
NEAR = AxisMemory(176.0, 0.0, homed=True), AxisMemory(68.0, 0.0, homed=True)
FAR = AxisMemory(90.0, 0.0, homed=True), AxisMemory(20.0, 0.0, homed=True)
"""Where a panel stands at first: beside the sun, or half a minute away from it."""
LONGEST_COAST_S = 0.5 + 0.5 + 1.2
"""From what was last told of a drive to its rest: the pause between two publications, watchdog and ramp."""
USUAL = TrackerConfig("T", "T")
PUSH_S = 0.06
STOWS = (ActivityName.STOWING, ActivityName.STOWED)


class Left(StrEnum):
    """What a tracker was left doing when the storm came."""

    TRACKING = "tracking"
    PARKED = "parked"
    STOWED = "stowed by command"
    SHOW = "running a show"
    TO_START = "on the way to a show"
    STOPPED = "stopped by a person"
    JOGGED = "moved by hand"

    @property
    def by_itself(self) -> bool:
        """Return whether a storm moves it to its stow position, as without any restart."""
        return self not in (Left.STOPPED, Left.JOGGED)


class When(StrEnum):
    """When the controller is killed: before the wind is reported, while it is, or afterwards."""

    BEFORE = "before"
    DURING = "during"
    AFTER = "after"


LATEST_KILL_S = {When.BEFORE: 0.3, When.DURING: 0.01, When.AFTER: 1.0}
AT_ONCE = 0.3
"""How often it is killed at the first instant."""


@dataclass
class Field:
    """Trackers that differ in what they were doing; the first ones hang on drives of another process."""

    lefts: dict[str, Left]
    port: int
    drives: int

    @classmethod
    def of(cls, size: int, *, port: int, drives: int) -> "Field":
        """Return a field most of whose trackers track; the last six are something else."""
        others = [one for one in Left if one is not Left.TRACKING]
        names = [f"T{number}" for number in range(1, size + 1)]
        kinds = [Left.TRACKING] * (size - len(others)) + others
        return cls(dict(zip(names, kinds, strict=True)), port, drives)

    def seed(self, folder: Path) -> None:
        """Store a site whose trackers were commissioned, and homed drives."""
        settings = Settings(data_dir=folder)
        folder.mkdir(parents=True)
        upgrade(settings.url)
        writer, positions = open_writer(settings.url), KeptPositions(folder / "drives")
        now = datetime.now(UTC)
        clock = ClockSetting("manual", (NOON - now).total_seconds(), now, "technician")
        writer.save_site(SiteState("Storm", SAMSUN, 1, "Europe/Istanbul", clock))
        for number, (name, left) in enumerate(self.lefts.items()):
            writer.save_tracker(TrackerState(self._config(number, name), _memory(left, now)))
            far = left is Left.TO_START or (left is Left.TRACKING and number % 2)
            home(positions.of(name), FAR if far else NEAR)
        writer.close()

    def _config(self, number: int, name: str) -> TrackerConfig:
        drive = DriveConfig()
        if number < self.drives:
            drive = DriveConfig(DriveKind.MODBUS_TCP, port=self.port, unit=number + 1)
        return TrackerConfig(name, name, drive=drive)


def home(memory: Memory, stands: tuple[AxisMemory, AxisMemory]) -> None:
    """Make a drive know where it stands."""
    memory.keep(PositionMemory(*stands, boot_count=1, trusted=True))


def drive_memories(folder: Path, drives: int) -> Path:
    """Return the memory of `drive-sim` with homed drives at units from 1 on."""
    first = folder / "sim.json"
    for unit in range(1, drives + 1):
        home(PositionFile(first if unit == 1 else first.with_name(f"sim-{unit}.json")), NEAR)
    return first


def _memory(left: Left, now: datetime) -> TrackerMemory:
    saved = Confirmation(now, "technician", 1)
    return TrackerMemory(
        mode=Mode.DUAL,
        tracking_on=left is Left.TRACKING,
        home=HomeTrust(now, "technician", "set", 1),
        confirmations={StepName.HOMING: saved, StepName.MODE: saved},
        stow={Left.PARKED: StowName.PARK, Left.STOWED: StowName.CLEANING}.get(left),
    )


@dataclass
class Storm:
    """Kills one field again and again, each time in a storm of its own."""

    plot: Field
    seed: Path
    folder: Path
    dice: random.Random
    counted: Counter[str] = field(default_factory=Counter)
    slowest_s: float = 0.0
    text: str = ""

    async def kill(self, number: int) -> None:
        """Live through one storm and one kill; fail if a tracker does not do what it has to."""
        machine = self._machine(number)
        try:
            await self._kill(machine, list(When)[number % len(When)])
        finally:
            await machine.stop()
            shutil.rmtree(machine.settings.data_dir)

    def _machine(self, number: int) -> Machine:
        machine = Machine.of(self.folder / f"storm-{number}")
        shutil.rmtree(machine.settings.data_dir)
        shutil.copytree(self.seed, machine.settings.data_dir)
        return machine

    async def _kill(self, machine: Machine, when: When) -> None:
        self.counted[when] += 1
        pressing = await self._begin(machine)
        before = latest(machine)
        acknowledged = await self._storm(machine, when)
        await _over(pressing)
        before = machine.link.latest() or before
        await machine.forget()
        at = time.monotonic()
        await machine.start()
        await self._stowed(machine, at, acknowledged=acknowledged)
        self._check(before, latest(machine), acknowledged=acknowledged)

    async def _begin(self, machine: Machine) -> "asyncio.Task[None]":
        """Start it in calm weather, and set going what does not go by itself."""
        await machine.start()
        await begin(machine, ReportWeather(CALM), None)
        await until(machine, lambda seen: all(one.homed for one in seen.trackers))
        for name, left in self.plot.lefts.items():
            if left is Left.TO_START:
                await begin(machine, GoToStart(SHOW), name)
            elif left is Left.SHOW:
                await self._run_show(machine, name)
        jogged = next(name for name, left in self.plot.lefts.items() if left is Left.JOGGED)
        await until(machine, lambda seen: all(map(self._is_under_way, seen.trackers)))
        return asyncio.create_task(_hold(machine, jogged))

    async def _run_show(self, machine: Machine, name: str) -> None:
        await begin(machine, GoToStart(SHOW), name)
        await until(machine, lambda seen: _is_ready(tracker(seen, name)))
        await begin(machine, RunShow(SHOW), name)

    def _is_under_way(self, seen: Snapshot) -> bool:
        left = self.plot.lefts[seen.tracker_id]
        if left in (Left.SHOW, Left.TO_START):
            return seen.activity is ActivityName.SHOWING
        return left is not Left.TRACKING or seen.activity is ActivityName.TRACKING

    async def _storm(self, machine: Machine, when: When) -> bool:
        """Report the wind and kill; return whether the report was acknowledged."""
        reporting = asyncio.create_task(_report(machine)) if when is not When.BEFORE else None
        if when is When.AFTER and reporting is not None:
            await reporting
        at_once = self.dice.random() < AT_ONCE
        await asyncio.sleep(0.0 if at_once else self.dice.uniform(0.0, LATEST_KILL_S[when]))
        machine.kill()
        return reporting is not None and await reporting

    async def _stowed(self, machine: Machine, at: float, *, acknowledged: bool) -> None:
        """Fail unless all that move by themselves go to their stow positions in time after the restart.

        What was not acknowledged is reported again, as a weather station does.
        """
        if not acknowledged:
            await ask(machine, ReportWeather(STORM), None)
        await until(machine, self._all_stow, within_s=STOWS_WITHIN_S)
        self.slowest_s = max(self.slowest_s, time.monotonic() - at)
        assert time.monotonic() - at <= STOWS_WITHIN_S

    def _all_stow(self, seen: SiteSnapshot) -> bool:
        """Return whether all stow, and every drive was read in this very snapshot: a late one is unknown."""
        return all(map(_is_read, seen.trackers)) and all(
            one.activity in STOWS for one in seen.trackers if self.plot.lefts[one.tracker_id].by_itself
        )

    def _check(self, before: SiteSnapshot, after: SiteSnapshot, *, acknowledged: bool) -> None:
        """Fail if wind, home or place was forgotten, or if something moves that a person had stopped."""
        weather = after.weather
        assert weather is not None
        assert (weather.readings.wind_mps, weather.simulated) == (STORM.wind_mps, False)
        assert weather.before_restart is weather.stale
        assert weather.before_restart or not acknowledged
        assert weather.age_s <= STOWS_WITHIN_S + LATEST_KILL_S[When.AFTER]
        protection = tracker(after, "T1").protection
        assert protection is not None
        self.text = protection.reason.message
        assert "The wind at T1" in self.text
        for one in after.trackers:
            left = self.plot.lefts[one.tracker_id]
            assert one.homed, one
            assert left.by_itself or one.activity is ActivityName.HOLDING, one
            assert left.by_itself or one.protection is not None, one
            _check_place(tracker(before, one.tracker_id), one)


def _check_place(before: Snapshot, after: Snapshot) -> None:
    """Fail if an axis stands farther from where it was seen last than it can have coasted."""
    for axis, config in ((Axis.AZIMUTH, USUAL.azimuth), (Axis.ELEVATION, USUAL.elevation)):
        away_deg = abs(_place_deg(after, axis) - _place_deg(before, axis))
        assert away_deg <= config.speed_dps * LONGEST_COAST_S, (axis, before, after)


def _is_read(seen: Snapshot) -> bool:
    axes = (seen.azimuth, seen.elevation)
    return all(axis is not None and axis.position_deg is not None for axis in axes)


def _place_deg(seen: Snapshot, axis: Axis) -> float:
    state = seen.azimuth if axis is Axis.AZIMUTH else seen.elevation
    assert state is not None, seen
    assert state.position_deg is not None, seen
    return state.position_deg


async def _report(machine: Machine) -> bool:
    try:
        await ask(machine, ReportWeather(STORM), None)
    except MachineUnreachable:
        return False
    return True


async def ask(machine: Machine, command: object, tracker_id: str | None) -> SiteSnapshot:
    """Give an order once."""
    return await machine.link.execute(Order(command, "technician", tracker_id))  # type: ignore[arg-type]


async def begin(machine: Machine, command: object, tracker_id: str | None) -> None:
    """Give an order before the storm; one that is answered too late is carried out all the same."""
    with suppress(MachineUnreachable):
        await ask(machine, command, tracker_id)


async def _hold(machine: Machine, name: str) -> None:
    """Hold a button until the machine is dead."""
    press = Jog(uuid4().hex, Axis.AZIMUTH, 1, JogSpeed.SLOW)
    with suppress(MachineUnreachable):
        while machine.lives[-1].is_alive():
            await ask(machine, press, name)
            press = replace(press, sequence=press.sequence + 1)
            await asyncio.sleep(PUSH_S)


async def until(machine: Machine, reached: Callable[[SiteSnapshot], bool], *, within_s: float = 40.0) -> None:
    """Return once what is known of the site is so, or fail and say what is."""

    def is_so() -> bool:
        seen = machine.link.latest()
        return seen is not None and reached(seen)

    try:
        await eventually(is_so, within_s=within_s)
    except TimeoutError as error:
        told = Counter((one.activity, one.activity_text) for one in latest(machine).trackers)
        raise AssertionError(f"{error} {told}") from error


def latest(machine: Machine) -> SiteSnapshot:
    """Return what is known of the site."""
    seen = machine.link.latest()
    assert seen is not None, machine.log()
    return seen


def tracker(seen: SiteSnapshot, name: str) -> Snapshot:
    """Return one tracker."""
    return next(one for one in seen.trackers if one.tracker_id == name)


def _is_ready(seen: Snapshot) -> bool:
    return seen.show is not None and seen.show.phase is ShowPhase.READY


async def _over(pressing: "asyncio.Task[None]") -> None:
    pressing.cancel()
    await asyncio.gather(pressing, return_exceptions=True)
