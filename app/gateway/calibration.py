"""Calibrate, as SunSpec means it: stop, search the origin switches, and go back to automatic."""

from dataclasses import dataclass
from enum import Enum, auto

from app.base.message import N_, say
from app.gateway.ports import Door, Update, refused, send
from app.link.messages import RequestControl, UnknownTracker
from app.tracker.commands.commands import CommandRejected, Home, Stop, Track
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.values.reason import Reason

PASSING = ("busy_", "axes_moving")
BY_HAND = {"busy_jogging", "busy_setting_home", "busy_measuring"}
"""What somebody does who stands at the machine: that work is not taken over."""
COMES_TO_REST = {ActivityName.STOPPING, ActivityName.HOLDING}


class _Phase(Enum):
    STOPPING = auto()
    HOMING = auto()


@dataclass(frozen=True, slots=True)
class Calibration:
    """How far a calibration has come, and who ordered it."""

    phase: _Phase
    actor: str


class Calibrations:
    """Which trackers are being calibrated; whoever else stops or moves one ends its calibration."""

    def __init__(self, door: Door) -> None:
        self._door = door
        self._running: dict[str, Calibration] = {}

    @property
    def trackers(self) -> frozenset[str]:
        """Return the trackers that are being calibrated."""
        return frozenset(self._running)

    async def begin(self, tracker: Snapshot, actor: str) -> None:
        """Begin with one tracker, or raise `CommandRejected` before anything is stopped."""
        against = lasting(await self._now(tracker))
        if against:
            rejected = CommandRejected(*against)
            refused(
                self._door,
                tracker.tracker_id,
                actor,
                say("The calibration was not started: {rejected}", rejected=rejected),
            )
            raise rejected
        await send(self._door, RequestControl((tracker.tracker_id,)), tracker.tracker_id, actor)
        if (await self._now(tracker)).actions["home"]:
            await send(self._door, Stop(), tracker.tracker_id, actor)
            self._running[tracker.tracker_id] = Calibration(_Phase.STOPPING, actor)
        else:
            await self._home(tracker.tracker_id, actor)

    def forget(self, tracker_id: str) -> Calibration | None:
        """End a calibration, because something else was ordered at this door, and return it."""
        return self._running.pop(tracker_id, None)

    def restore(self, tracker_id: str, calibration: Calibration | None) -> None:
        """Go on with a calibration, because what was ordered instead was refused."""
        if calibration is not None:
            self._running.setdefault(tracker_id, calibration)

    async def follow(self, update: Update) -> None:
        """Take every calibration on as far as the update allows."""
        if not self._running:
            return
        trackers = {one.tracker_id: one for one in update.snapshot.trackers}
        for tracker_id, running in tuple(self._running.items()):
            tracker = trackers.get(tracker_id)
            if tracker is None:
                self.forget(tracker_id)
                continue
            events = tuple(event for event in update.events if event.tracker_id == tracker_id)
            try:
                await self._step(tracker, running, events)
            except (CommandRejected, UnknownTracker):
                self.forget(tracker_id)

    async def _now(self, tracker: Snapshot) -> Snapshot:
        """Return a tracker with what may be asked of it, which snapshots leave out."""
        return await self._door.tracker(tracker.tracker_id)

    async def _step(self, tracker: Snapshot, running: Calibration, events: tuple[Event, ...]) -> None:
        if any(event.kind is EventKind.STOPPED and event.actor != running.actor for event in events):
            self._give_up(tracker, running, N_("the tracker was stopped."))
        elif running.phase is _Phase.HOMING:
            await self._homing(tracker, running, events)
        elif tracker.activity not in COMES_TO_REST:
            self._give_up(tracker, running, say("the tracker is {activity}.", activity=tracker.activity))
        elif not (await self._now(tracker)).actions["home"]:
            await self._home(tracker.tracker_id, running.actor)

    async def _homing(self, tracker: Snapshot, running: Calibration, events: tuple[Event, ...]) -> None:
        ended = next((event for event in events if event.kind is EventKind.HOMING_ENDED), None)
        if ended is None:
            if tracker.activity is not ActivityName.HOMING:
                self._give_up(tracker, running, N_("homing was interrupted."))
            return
        self.forget(tracker.tracker_id)
        if ended.data.get("outcome") == "homed":
            await send(self._door, Track(), tracker.tracker_id, running.actor)

    async def _home(self, tracker_id: str, actor: str) -> None:
        await send(self._door, Home(), tracker_id, actor)
        self._running[tracker_id] = Calibration(_Phase.HOMING, actor)

    def _give_up(self, tracker: Snapshot, running: Calibration, why: str) -> None:
        self.forget(tracker.tracker_id)
        message = say("The calibration was aborted, and tracking was not started: {why}", why=why)
        refused(self._door, tracker.tracker_id, running.actor, message)


def lasting(tracker: Snapshot) -> tuple[Reason, ...]:
    """Return what forbids homing and would still forbid it after a stop, or forbids to stop for it."""
    return tuple(
        reason
        for reason in tracker.actions["home"]
        if reason.code in BY_HAND or not reason.code.startswith(PASSING)
    )
