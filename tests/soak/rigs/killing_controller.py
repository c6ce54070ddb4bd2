"""A machine that is killed while its axes turn, and what has to be so after each kill."""

import asyncio
import random
import sqlite3
from collections import Counter
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from enum import StrEnum
from pathlib import Path
from typing import Any, Literal, assert_never
from uuid import uuid4

from app.audit.chain import first_break
from app.link.messages import ConfigureTracker, MachineUnreachable, RenameSite, SetClock, SetLocation
from app.store.engine import open_reader
from app.store.reader import DatabaseReader
from app.store.store import AuditFilter, JournalFilter
from app.tracker.commands.commands import (
    CommandRejected,
    GoToStart,
    Jog,
    Move,
    RunShow,
    SelectMode,
    SetHome,
    Stop,
    Track,
)
from app.tracker.memory.recording import RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, Event, EventKind, ShowPhase, Snapshot
from app.tracker.values.mode import Mode
from tests.machine.lives import Machine
from tests.machine.service import SAMSUN, config_for
from tests.patience import eventually
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_product import LATEST_FEED_S, RAMP_S, WATCHDOG_S

MORNING = datetime(2027, 6, 21, 3, 0, tzinfo=UTC)
SHOW = ShowPlan("morning", MORNING, MORNING + timedelta(minutes=90), timedelta(seconds=20), SAMSUN)
FAR_DEG = 10.0
AWAY_WITHIN_DEG = 1.0
LONGEST_INSTANT_S = 1.0
LONGEST_S = WATCHDOG_S + LATEST_FEED_S + RAMP_S
LATEST_RENAMING_S = 0.01
SIDES = (Orientation(50.0, 10.0), Orientation(92.0, 25.0))
SETTLED_S = 0.3
LOOKED_AT = 50
PUSH_S = 0.06


class Motion(StrEnum):
    """What the machine is killed in the middle of."""

    MOVE = "move"
    TRACK = "track"
    GO_TO_START = "go_to_start"
    SHOW = "show"
    JOG = "jog"


@dataclass
class Killing:
    """One machine, one drive in another process, eyes on it, and the dice."""

    machine: Machine
    eyes: Eyes
    dice: random.Random
    names: list[str] = field(default_factory=list)
    promised: int = 0
    counted: Counter[str] = field(default_factory=Counter)
    told: str = ""

    async def commission(self, port: int) -> None:
        """Start it, point it at the drive, give it a place, a clock and a zero."""
        await self.machine.start()
        await self.machine.ask(ConfigureTracker(config_for(port)))
        await self.machine.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.machine.ask(SetClock("manual", MORNING))
        await self._until(lambda seen: not seen.actions["set_home"], "the zero can be set")
        await self.machine.ask(SetHome())
        await self._until(lambda seen: seen.homed, "the zero is trusted")
        await self.machine.ask(SelectMode(Mode.DUAL))

    async def kill(self) -> float:
        """Kill it at an instant of a motion; return after how long the axes stood, all else checked."""
        motion = self.dice.choice(list(Motion))
        self.counted[motion] += 1
        pressing = await self._turning(motion)
        await asyncio.sleep(self.dice.uniform(0.0, LONGEST_INSTANT_S))
        renaming = await self._rename()
        at = self.machine.kill()
        await _over(pressing, renaming)
        rested_s = await asyncio.to_thread(self.eyes.first_rest_after, at)
        assert rested_s <= LONGEST_S + self.eyes.longest_blink_s(at)
        await self.machine.forget()
        assert not self.eyes.moved_after(at + rested_s)
        await self.machine.start()
        await self._until(lambda seen: seen.measured is not None, "the drive is found again")
        await self._check_motion(at + rested_s, motion)
        await self._until_told()
        self._check_kept()
        return rested_s

    async def _turning(self, motion: "Motion") -> "asyncio.Task[None] | None":
        """Return once the axes turn; a motion that a lost drive ended at once is begun again.

        So is one that was over before a busy computer looked, and an order that was answered too late.
        """
        while True:
            losses, begun_at = self._losses(), self.eyes.now.at
            try:
                pressing = await self._begin(motion)
            except MachineUnreachable:
                self.counted["answered too late"] += 1
                continue
            try:
                await asyncio.to_thread(self.eyes.until_moving)
            except AssertionError:
                seen = self._losses() > losses or self.eyes.moved_after(begun_at)
                assert seen, f"{motion} did not begin: {self.machine.tracker}"
                self.counted["begun again"] += 1
            else:
                return pressing

    def _losses(self) -> int:
        """Return how often the drive has answered too late."""
        with closing(open_reader(self._url)) as reader:
            return len(reader.journal(JournalFilter(limit=1000, kinds=(EventKind.DRIVE_LOST,))))

    @property
    def _url(self) -> str:
        return f"sqlite:///{self._path}"

    @property
    def _path(self) -> Path:
        return self.machine.settings.data_dir / "heliopanel.db"

    async def _begin(self, motion: "Motion") -> "asyncio.Task[None] | None":
        await self.machine.ask(Stop())
        await self._until(lambda seen: not seen.actions["jog"], "motion is allowed")
        side = self._far_side()
        match motion:
            case Motion.MOVE:
                await self.machine.ask(Move(side))
            case Motion.TRACK:
                await self._away_from_the_sun()
                await self.machine.ask(Track())
            case Motion.GO_TO_START:
                await self._away_from_the_sun()
                await self.machine.ask(GoToStart(SHOW))
            case Motion.SHOW:
                await self._stand_at_the_start()
                await self.machine.ask(RunShow(SHOW))
            case Motion.JOG:
                direction: Literal[-1, 1] = 1 if side is SIDES[1] else -1
                press = Jog(uuid4().hex, Axis.AZIMUTH, direction, JogSpeed.FAST)
                return asyncio.create_task(self._hold(press))
            case _:
                assert_never(motion)
        return None

    def _far_side(self) -> Orientation:
        seen = self.machine.tracker.measured
        assert seen is not None
        return max(SIDES, key=lambda side: abs(side.azimuth_deg - seen.azimuth_deg))

    async def _stand_at_the_start(self) -> None:
        """Go to the start, again where the drive answered too late on the way, which ends a show."""
        while not _is_ready(self.machine.tracker):
            await self.machine.ask(GoToStart(SHOW))
            await self._until(lambda seen: seen.show is None or _is_ready(seen), "the show is ready")

    async def _away_from_the_sun(self) -> None:
        """Turn away where a motion to the sun, or to the show's start beside it, would be over at once."""
        seen = self.machine.tracker.measured
        assert seen is not None
        if abs(seen.azimuth_deg - self.machine.tracker.sun.azimuth_deg) > FAR_DEG:
            return
        await self.machine.ask(Move(SIDES[1]))
        await self._until(_is_away, "the panel is away from the sun")

    async def _hold(self, press: Jog) -> None:
        """Hold a key until the machine is dead; where a busy computer renewed it too late, press it again."""
        life = self.machine.lives[-1]
        while life.is_alive():
            try:
                await self.machine.ask(press)
                press = replace(press, sequence=press.sequence + 1)
            except CommandRejected:
                press = replace(press, press_id=uuid4().hex, sequence=0)
            except MachineUnreachable:
                pass
            await asyncio.sleep(PUSH_S)

    async def _rename(self) -> "asyncio.Task[object]":
        """Give the site a name that is acknowledged, then one that may be cut off."""
        await self.machine.ask(RenameSite(self._name()))
        self.promised = len(self.names)
        late = asyncio.create_task(self.machine.ask(RenameSite(self._name())))
        await asyncio.sleep(self.dice.uniform(0.0, LATEST_RENAMING_S))
        return late

    def _name(self) -> str:
        self.names.append(f"Run {len(self.names)}")
        return self.names[-1]

    async def _check_motion(self, rested_at: float, motion: "Motion") -> None:
        """Fail if anything turns after the restart that nobody asked for; tracking goes on by itself."""
        if motion is Motion.TRACK:
            await self._until(lambda seen: seen.activity is ActivityName.TRACKING, "tracking goes on")
            return
        await asyncio.sleep(SETTLED_S)
        assert not self.eyes.moved_after(rested_at)
        assert self.machine.tracker.activity is ActivityName.HOLDING
        assert not self.machine.tracker.tracking_on

    def _check_kept(self) -> None:
        """Fail if anything acknowledged is lost, anything is there by half, or the database is not whole."""
        with closing(sqlite3.connect(f"file:{self._path}?mode=ro", uri=True)) as database:
            assert database.execute("PRAGMA quick_check").fetchall() == [("ok",)]
        with closing(open_reader(self._url)) as reader:
            self._check_names(reader)
            shows = reader.recordings(kind=RecordingKind.SHOW)
            chain = reader.audit(AuditFilter(limit=LOOKED_AT))
        assert all(show.ended_at is not None for show in shows)
        assert first_break([one.link() for one in chain[-2::-1]], after=chain[-1].link()) is None

    def _check_names(self, reader: DatabaseReader) -> None:
        site = reader.site()
        assert site is not None
        kinds = (EventKind.TRACKER_CHANGED,)
        entries = reader.journal(JournalFilter(limit=LOOKED_AT, kinds=kinds))
        told = [entry.event.message for entry in reversed(entries)]
        if site.name != self.names[-1]:
            self.names.pop()
        assert len(self.names) >= self.promised
        expected = [f"The site is now called {name}." for name in self.names]
        assert site.name == self.names[-1]
        assert [one for one in told if one in expected] == expected[-len(told) :]

    def _starts(self) -> list[Event]:
        """Return the newest starts that the journal tells of, newest first."""
        wanted = JournalFilter(limit=LOOKED_AT, kinds=(EventKind.CONTROLLER_STARTED,))
        with closing(open_reader(self._url)) as reader:
            return [entry.event for entry in reader.journal(wanted)]

    async def _until_told(self) -> None:
        """Return once the journal tells of every start, the last of which was not a clean one."""
        await eventually(lambda: len(self._starts()) >= min(LOOKED_AT, len(self.machine.lives)))
        newest = self._starts()[0]
        assert newest.data["clean"] is False
        assert "unexpectedly" in newest.message
        self.told = newest.message

    async def _until(self, reached: Callable[[Snapshot], bool], what: str) -> None:
        def is_so() -> bool:
            latest = self.machine.link.latest()
            return latest is not None and bool(latest.trackers[0].actions) and reached(latest.trackers[0])

        try:
            await eventually(is_so)
        except TimeoutError as error:
            raise TimeoutError(f"{error} Waited for: {what}. {self.machine.tracker}") from error


def _is_away(seen: Snapshot) -> bool:
    far = (
        seen.measured is not None and abs(seen.measured.azimuth_deg - SIDES[1].azimuth_deg) < AWAY_WITHIN_DEG
    )
    return far and seen.activity is ActivityName.HOLDING


def _is_ready(seen: Snapshot) -> bool:
    return seen.show is not None and seen.show.phase is ShowPhase.READY


async def _over(*tasks: "asyncio.Task[Any] | None") -> None:
    """Wait for tasks that the kill may have cut off."""
    for task in tasks:
        if task is not None:
            with suppress(MachineUnreachable):
                await task
