"""The machine killed again and again while its axes turn: nothing is lost, and the drive stops by itself."""

import asyncio
import os
import random
import re
import sqlite3
from collections import Counter
from collections.abc import AsyncIterator, Awaitable
from contextlib import AsyncExitStack, closing, suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from time import monotonic
from uuid import uuid4

import pytest

from app.audit.chain import first_break
from app.link.messages import ConfigureTracker, MachineUnreachable, RenameSite, SetClock, SetLocation
from app.store.store import AuditFilter
from app.tracker.commands.commands import GoToStart, Jog, Move, RunShow, SelectMode, SetHome, Stop, Track
from app.tracker.memory.recording import RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase, Snapshot
from app.tracker.values.mode import Mode
from tests.e2e.product import DriveSim
from tests.fault_result import REAL, FaultResult
from tests.machine.lives import Machine
from tests.machine.service import SAMSUN, config_for
from tests.patience import eventually
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_product import LATEST_FEED_S, RAMP_S, WATCHDOG_S

MORNING = datetime(2027, 6, 21, 3, 0, tzinfo=UTC)
SHOW = ShowPlan("morning", MORNING, MORNING + timedelta(minutes=90), timedelta(seconds=20), SAMSUN)
MOTIONS = ("move", "track", "go_to_start", "show", "jog")
"""What the machine is killed in the middle of."""
NEAR, FAR = Orientation(50.0, 10.0), Orientation(92.0, 25.0)
"""Beside the sun of the morning, and away from it."""
LONGEST_INSTANT_S = 1.0
LONGEST_S = WATCHDOG_S + LATEST_FEED_S + RAMP_S
LATEST_RENAMING_S = 0.01
SETTLED_S = 0.3
LOOKED_AT = 50
TRIES = 5


@dataclass
class Killing:
    """One machine, one drive in another process, eyes on it, and the dice."""

    machine: Machine
    eyes: Eyes
    dice: random.Random
    names: list[str] = field(default_factory=list)
    counted: Counter[str] = field(default_factory=Counter)
    told: str = ""

    async def commission(self, port: int) -> None:
        """Start it, point it at the drive, give it a place, a clock and a zero."""
        await self.machine.start()
        await self.machine.ask(ConfigureTracker(config_for(port)))
        await self.machine.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
        await self.machine.ask(SetClock("manual", MORNING))
        await self._allowed("set_home")
        await self.machine.ask(SetHome())
        await self.machine.until_site(lambda seen: seen.trackers[0].homed, "the zero is trusted")
        await self.machine.ask(SelectMode(Mode.DUAL))

    async def kill(self) -> float:
        """Kill it at an instant of a motion; return after how long the axes stood, all else checked."""
        motion = self.dice.choice(MOTIONS)
        self.counted[motion] += 1
        pressing = await self._turning(motion)
        await asyncio.sleep(self.dice.uniform(0.0, LONGEST_INSTANT_S))
        await self._rename()
        promised, renaming = len(self.names), asyncio.create_task(self._rename())
        await asyncio.sleep(self.dice.uniform(0.0, LATEST_RENAMING_S))
        at = self.machine.kill()
        await asyncio.gather(*(one for one in (pressing, renaming) if one), return_exceptions=True)
        rested_s = await asyncio.to_thread(self.eyes.first_rest_after, at)
        assert rested_s <= LONGEST_S + self.eyes.longest_blink_s(at)
        await self.machine.forget()
        assert not self.eyes.moved_after(at + rested_s)
        await self.machine.start()
        await self.machine.until_site(lambda seen: seen.trackers[0].measured, "the drive is found again")
        await self._check_motion(at + rested_s, motion)
        await self._check_told()
        self._check_kept(promised)
        return rested_s

    async def _turning(self, motion: str) -> "asyncio.Task[None] | None":
        """Return once the axes turn; a motion that a busy computer ended or missed begins again."""
        for _ in range(TRIES):
            with suppress(MachineUnreachable, AssertionError):
                pressing = await self._begin(motion)
                await asyncio.to_thread(self.eyes.until_moving)
                return pressing
            self.counted["begun again"] += 1
        raise AssertionError(f"{motion} did not begin: {self.machine.tracker()}")

    async def _begin(self, motion: str) -> "asyncio.Task[None] | None":
        await self.machine.ask(Stop())
        await self._allowed("jog")
        if motion == "show":
            await self.machine.ask(GoToStart(SHOW))
            await self.machine.until_site(lambda seen: _is_ready(seen.trackers[0]), "the show is ready")
            await self.machine.ask(RunShow(SHOW))
            return None
        seen = self.machine.site.trackers[0].measured
        assert seen is not None
        if motion in ("track", "go_to_start") and abs(seen.azimuth_deg - FAR.azimuth_deg) > 1.0:
            await self.machine.ask(Move(FAR))
            await self.machine.until_site(
                lambda site: _is_far(site.trackers[0]), "the panel is away from the sun"
            )
        side = max(NEAR, FAR, key=lambda side: abs(side.azimuth_deg - seen.azimuth_deg))
        if motion == "jog":
            press = Jog(uuid4().hex, Axis.AZIMUTH, 1 if side is FAR else -1, JogSpeed.FAST)
            return asyncio.create_task(self.machine.hold("T1", press))
        await self.machine.ask({"move": Move(side), "track": Track(), "go_to_start": GoToStart(SHOW)}[motion])
        return None

    def _rename(self) -> Awaitable[object]:
        self.names.append(f"Run {len(self.names)}")
        return self.machine.ask(RenameSite(self.names[-1]))

    async def _check_motion(self, rested_at: float, motion: str) -> None:
        """Fail if anything turns after the restart that nobody asked for; tracking goes on by itself."""
        if motion == "track":
            await self.machine.until_site(
                lambda seen: seen.trackers[0].activity is ActivityName.TRACKING, "tracking goes on"
            )
            return
        await asyncio.sleep(SETTLED_S)
        assert not self.eyes.moved_after(rested_at)
        assert self.machine.site.trackers[0].activity is ActivityName.HOLDING
        assert not self.machine.site.trackers[0].tracking_on

    async def _check_told(self) -> None:
        """Fail unless the journal tells of every start, the last of which was not a clean one."""
        starts = min(LOOKED_AT, len(self.machine.lives))
        await eventually(lambda: len(self.machine.journal(EventKind.CONTROLLER_STARTED)) >= starts)
        newest = self.machine.journal(EventKind.CONTROLLER_STARTED)[0]
        assert newest.data["clean"] is False
        assert "unexpectedly" in newest.message
        self.told = newest.message

    def _check_kept(self, promised: int) -> None:
        """Fail if anything acknowledged is lost, anything is there by half, or the database is not whole."""
        path = self.machine.data_dir / "heliopanel.db"
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as database:
            assert database.execute("PRAGMA quick_check").fetchall() == [("ok",)]
        with self.machine.reader() as reader:
            site, shows = reader.site(), reader.recordings(kind=RecordingKind.SHOW)
            chain = reader.audit(AuditFilter(limit=LOOKED_AT))
        assert all(show.ended_at is not None for show in shows)
        assert first_break([one.link() for one in chain[-2::-1]], after=chain[-1].link()) is None
        assert site is not None
        if site.name != self.names[-1]:
            self.names.pop()
        assert len(self.names) >= promised
        assert site.name == self.names[-1]
        told = [event.message for event in reversed(self.machine.journal(EventKind.TRACKER_CHANGED))]
        expected = [f"The site is now called {name}." for name in self.names]
        assert [one for one in told if one in expected] == expected[-len(told) :]

    async def _allowed(self, action: str) -> None:
        await self.machine.until_site(
            lambda seen: seen.trackers[0].actions and not seen.trackers[0].actions[action],
            f"{action} is allowed",
        )


def _is_far(seen: Snapshot) -> bool:
    far = seen.measured is not None and abs(seen.measured.azimuth_deg - FAR.azimuth_deg) < 1.0
    return far and seen.activity is ActivityName.HOLDING


def _is_ready(seen: Snapshot) -> bool:
    assert seen.show is not None, "a drive that answers too late ends a show"
    return seen.show.phase is ShowPhase.READY


KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "3"))
SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "1"))


@pytest.fixture
async def killing(tmp_path: Path) -> AsyncIterator[Killing]:
    machine = Machine.of(tmp_path / "data")
    async with AsyncExitStack() as started:
        drive = DriveSim.start()
        started.callback(drive.stop)
        eyes = Eyes(drive.port)
        started.push_async_callback(machine.stop)
        started.callback(eyes.close)
        killing = Killing(machine, eyes, random.Random(SEED))
        await killing.commission(drive.port)
        yield killing


@pytest.mark.timeout(60 + 15 * KILLS)
@pytest.mark.fault(43)
async def test_killed_in_motion_nothing_is_lost_and_nothing_moves_on(
    killing: Killing, fault: FaultResult
) -> None:
    begun, latest_s = monotonic(), 0.0
    for _ in range(KILLS):
        latest_s = max(latest_s, await killing.kill())
    counted = ", ".join(f"{motion} {times}" for motion, times in sorted(killing.counted.items()))
    print(f"{KILLS} kills in {monotonic() - begun:.0f} s ({counted}), at rest after at most {latest_s:.2f} s")
    fault.noticed(latest_s, REAL)
    fault.recovers("automatic: the controller starts again; tracking that was on resumes, nothing else moves")
    fault.shows(re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d", "AT", killing.told))
