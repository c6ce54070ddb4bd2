"""What a plant's control system writes: targets are kept, and the control register acts."""

from collections.abc import Mapping
from dataclasses import replace
from typing import assert_never

from app.base.message import N_, join, say, with_format
from app.gateway.calibration import Calibrations
from app.gateway.ports import SUNSPEC, Door, Update, refused, send, written
from app.gateway.quiet_door import QuietDoor
from app.gateway.sunspec_values import Control, Targets
from app.link.messages import Order, RenewControl, RequestControl, UnknownTracker
from app.modbus.server import ILLEGAL_ADDRESS, ILLEGAL_VALUE, Refusal
from app.tracker.commands.commands import CommandRejected, Move, Track
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.reason import Reason

ACTOR = "sunspec "
"""What the actor of every order of this door begins with; the host follows."""
BUSY = 6
SAME_PLACE_DEG = 0.5
TARGETS = {"ElCtl": (-90.0, 90.0), "AzCtl": (0.0, 360.0)}
TAKES_OVER = {
    EventKind.STOPPED,
    EventKind.JOG_STARTED,
    EventKind.MOVE_STARTED,
    EventKind.HOMING_STARTED,
    EventKind.TRACKING_STARTED,
    EventKind.SHOW_STARTED,
    EventKind.FAULT_RAISED,
    EventKind.DRIVE_LOST,
    EventKind.HOME_LOST,
}
WRONG_VALUE = {"beyond_limits", "no_target"}
NO_TARGET = Reason(
    "no_target",
    N_("Manual mode was written without a target."),
    N_("Write ElCtl and AzCtl, then write 1 to Ctl."),
)

Written = Mapping[str, float | None]
"""Values by the names of model 601's points; those for all trackers begin with Glbl."""


class Controls:
    """Carries out what is written through the same orders as every door, and journals all of it.

    A target moves nothing until manual control is written; from then on new targets are gone to at once,
    until somebody else takes the tracker over.
    """

    def __init__(self, door: Door) -> None:
        door = QuietDoor(door)
        self._door: Door = door
        self._written: dict[tuple[str | None, str, str], float | None] = {}
        self._last: dict[str, tuple[Control, Targets]] = {}
        self.targets: dict[str | None, Targets] = {}
        self.calibrations = Calibrations(door)
        self._manual: set[str] = set()

    async def write(self, tracker_id: str | None, values: Written, actor: str) -> None:
        """Keep targets and act on the control register; None writes for all trackers.

        Raises `Refusal` with exception 3 for a value that cannot be, 6 for what is not possible now; nothing
        of what is refused is kept.
        """
        told = ", ".join(f"{name} = {_said(value)}" for name, value in values.items())
        values = {name.removeprefix("Glbl"): value for name, value in values.items()}
        self._check(tracker_id, values, actor)
        before = self.targets.get(tracker_id, Targets())
        kept = replace(
            before,
            elevation_deg=values.get("ElCtl", before.elevation_deg),
            azimuth_deg=values.get("AzCtl", before.azimuth_deg),
        )
        self.targets[tracker_id] = kept
        if self._has_changed(tracker_id, values, actor):
            written(self._door, tracker_id, actor, say("{told} was written over SunSpec.", told=told))
        try:
            if "Ctl" in values:
                await self._act(tracker_id, Control(int(values["Ctl"] or 0)), kept, actor)
            elif tracker_id in self._manual:
                await self._act(tracker_id, Control.MANUAL, kept, actor)
        except Refusal:
            self.targets[tracker_id] = before
            raise

    async def follow(self, update: Update) -> None:
        """Let go of manual control where somebody else took it or a fault ended it; go on calibrating."""
        for event in update.events:
            if event.kind in TAKES_OVER and not event.actor.startswith(ACTOR):
                self._manual.discard(event.tracker_id or "")
                self._last.pop(event.tracker_id or "", None)
        await self.calibrations.follow(update)

    def _has_changed(self, tracker_id: str | None, values: Written, actor: str) -> bool:
        """Return whether one of these values was not written last by this host, and keep them."""
        places = {(tracker_id, actor, name): value for name, value in values.items()}
        changed = any(place not in self._written or self._written[place] != places[place] for place in places)
        self._written |= places
        return changed

    def _is_done(self, tracker: Snapshot, control: Control, targets: Targets) -> bool:
        """Return whether a tracker does already what is written once more, as control systems do it."""
        name = tracker.tracker_id
        if control is Control.CALIBRATE:
            return name in self.calibrations.trackers
        if self._last.get(name) != (control, targets):
            return False
        if control is Control.AUTOMATIC:
            return tracker.tracking_on and tracker.activity is ActivityName.TRACKING
        return name in self._manual and (
            tracker.activity is ActivityName.MOVING or _is_there(tracker, targets)
        )

    def _check(self, tracker_id: str | None, values: Written, actor: str) -> None:
        for name, value in values.items():
            low, high = TARGETS.get(name, (min(Control), max(Control)))
            if value is None or not low <= value <= high:
                name = name if tracker_id else "Glbl" + name
                message = say(
                    "{value} was written to {name} over SunSpec; it must lie between {low} and {high}.",
                    value=_said(value),
                    name=name,
                    low=with_format(low, "g"),
                    high=with_format(high, "g"),
                )
                refused(self._door, tracker_id, actor, message)
                raise Refusal(ILLEGAL_VALUE)

    async def _act(self, tracker_id: str | None, control: Control, targets: Targets, actor: str) -> None:
        """Act on one tracker or on all; of all, those that can do it, and it fails if none can.

        All of them need control of all: while a person has one, none is moved.
        """
        failures: list[Refusal] = []
        trackers = _addressed(self._door.latest(), tracker_id)
        if trackers and all(self._is_done(one, control, targets) for one in trackers):
            names = tuple(one.tracker_id for one in trackers)
            await self._door.execute(Order(RenewControl(names), actor, via=SUNSPEC))
            return
        if tracker_id is None and trackers:
            await self._take(tuple(one.tracker_id for one in trackers), actor)
        for tracker in trackers:
            try:
                await self._act_on(tracker, control, targets, actor, for_all=tracker_id is None)
            except CommandRejected as rejected:
                wrong = any(reason.code in WRONG_VALUE for reason in rejected.reasons)
                failures.append(Refusal(ILLEGAL_VALUE if wrong else BUSY))
            except UnknownTracker:
                failures.append(Refusal(ILLEGAL_ADDRESS))
        if len(failures) == len(trackers):
            raise failures[0] if failures else Refusal(BUSY)

    async def _take(self, tracker_ids: tuple[str, ...], actor: str) -> None:
        try:
            await send(self._door, RequestControl(tracker_ids), None, actor)
        except CommandRejected as rejected:
            raise Refusal(BUSY) from rejected

    async def _act_on(
        self, tracker: Snapshot, control: Control, targets: Targets, actor: str, *, for_all: bool
    ) -> None:
        """Act on one tracker; an order that is refused leaves manual control and calibration as they were."""
        name = tracker.tracker_id
        was_manual, calibration = name in self._manual, self.calibrations.forget(name)
        self._manual.discard(name)
        try:
            match control:
                case Control.AUTOMATIC:
                    await send(self._door, Track(), name, actor)
                    self._last[name] = control, targets
                case Control.MANUAL:
                    gone_to = await self._move(tracker, targets, actor)
                    self._manual.add(name)
                    self._last[name] = control, targets
                    if for_all:
                        self.targets[name] = gone_to
                case Control.CALIBRATE:
                    await self.calibrations.begin(tracker, actor)
                case _:
                    assert_never(control)
        except CommandRejected:
            self.calibrations.restore(name, calibration)
            if was_manual:
                self._manual.add(name)
            raise

    async def _move(self, tracker: Snapshot, targets: Targets, actor: str) -> Targets:
        """Go to the targets, and return them; an angle that was never written stays as it is measured."""
        azimuth_deg, elevation_deg = targets.azimuth_deg, targets.elevation_deg
        if tracker.measured is not None and (azimuth_deg is not None or elevation_deg is not None):
            azimuth_deg = tracker.measured.azimuth_deg if azimuth_deg is None else azimuth_deg
            elevation_deg = tracker.measured.elevation_deg if elevation_deg is None else elevation_deg
        if azimuth_deg is None or elevation_deg is None:
            refused(self._door, tracker.tracker_id, actor, join(" ", (NO_TARGET.message, NO_TARGET.hint)))
            raise CommandRejected(NO_TARGET)
        orientation = Orientation(azimuth_deg % 360.0, elevation_deg)
        await send(self._door, Move(orientation), tracker.tracker_id, actor)
        return Targets(elevation_deg, azimuth_deg)


def _is_there(tracker: Snapshot, targets: Targets) -> bool:
    """Return whether a tracker stands still where it was sent."""
    measured = tracker.measured
    if tracker.activity is not ActivityName.HOLDING or measured is None:
        return False
    azimuth_deg, elevation_deg = targets.azimuth_deg, targets.elevation_deg
    off_deg = (
        0.0 if azimuth_deg is None else abs((measured.azimuth_deg - azimuth_deg + 180.0) % 360.0 - 180.0)
    )
    if elevation_deg is not None:
        off_deg = max(off_deg, abs(measured.elevation_deg - elevation_deg))
    return off_deg <= SAME_PLACE_DEG


def _said(value: float | None) -> str:
    return N_("Nothing") if value is None else f"{value:g}"


def _addressed(site: SiteSnapshot | None, tracker_id: str | None) -> tuple[Snapshot, ...]:
    trackers = () if site is None else site.trackers
    return tuple(one for one in trackers if tracker_id in (None, one.tracker_id))
