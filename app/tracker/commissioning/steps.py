"""The five steps: done, to do or to be confirmed, each with its reasons."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import NamedTuple

from app.base.message import N_, Message, join, say
from app.tracker.memory.memory import Confirmation, SiteState, StepName, TrackerMemory
from app.tracker.state.snapshot import ActivityName, ClockState, ShowPhase, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason


class StepStatus(StrEnum):
    """Where a step stands."""

    TO_DO = "to_do"
    TO_BE_CONFIRMED = "to_be_confirmed"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class Step:
    """One of the five steps as the wizard and the API show it."""

    name: StepName
    status: StepStatus
    reasons: tuple[Reason, ...]
    confirmed_at: datetime | None
    confirmed_by: str


class Standing(NamedTuple):
    """What the steps go by of how a tracker stands now: nothing that differs from tick to tick."""

    seen: bool = False
    runs: bool = False
    waits: tuple[Reason, ...] = ()


def standing_of(snapshot: Snapshot) -> Standing:
    """Return how a tracker stands that is seen so."""
    runs = _is_running(snapshot)
    return Standing(snapshot.measured is not None, runs, () if runs else snapshot.waiting)


def steps(site: SiteState, memory: TrackerMemory, standing: Standing, clock: ClockState) -> tuple[Step, ...]:
    """Return the five steps of one tracker, in order, as they stand now.

    What needs the drive is not done while the tracker is not seen.
    """
    earlier = (
        _location(site),
        _clock(site, clock),
        _homing(site, memory, standing),
        _mode(site, memory),
    )
    return (*earlier, _run(earlier, standing))


def _location(site: SiteState) -> Step:
    reason = _LOCATION_UNKNOWN if site.location is None else None
    return _step(StepName.LOCATION, site.confirmations, to_do=(reason,))


def _clock(site: SiteState, clock: ClockState) -> Step:
    unset = _CLOCK_UNSET if site.clock.source == "unset" else None
    doubts: tuple[Reason, ...] = ()
    if unset is None and not clock.trusted:
        doubts = clock.reasons or (_CLOCK_UNTRUSTED,)
    moved = None if unset else _moved(site, site.confirmations.get(StepName.CLOCK))
    return _step(StepName.CLOCK, site.confirmations, to_do=(unset,), to_confirm=(*doubts, moved))


def _homing(site: SiteState, memory: TrackerMemory, standing: Standing) -> Step:
    if memory.home is None:
        lost = memory.home_lost
        reason = _home_lost(lost) if lost else _HOME_UNSET
        return _step(StepName.HOMING, memory.confirmations, to_do=(reason,))
    unseen = None if standing.seen else _DRIVE_SILENT
    moved = _moved(site, memory.confirmations.get(StepName.HOMING))
    return _step(StepName.HOMING, memory.confirmations, to_confirm=(unseen, moved))


def _mode(site: SiteState, memory: TrackerMemory) -> Step:
    saved = memory.confirmations.get(StepName.MODE)
    to_do: Reason | None = None
    if memory.mode is None:
        to_do = _MODE_UNSET
    elif saved is None and memory.mode is not Mode.DUAL:
        to_do = _NOT_THERE
    return _step(
        StepName.MODE,
        memory.confirmations,
        to_do=(to_do,),
        to_confirm=(_moved(site, saved) if saved else None,),
    )


def _run(earlier: Sequence[Step], standing: Standing) -> Step:
    """Return step 5: done while the tracker tracks or shows and every earlier step holds."""
    open_steps = tuple(_open(step) for step in earlier if step.status is not StepStatus.DONE)
    running = None if standing.runs else _NOT_RUNNING
    return _step(StepName.RUN, {}, to_do=(*open_steps, *standing.waits, running))


def _is_running(snapshot: Snapshot) -> bool:
    stowed = snapshot.tracking_on and snapshot.stow is not None
    if snapshot.activity is ActivityName.TRACKING or stowed:
        return True
    return snapshot.show is not None and snapshot.show.phase in (ShowPhase.RUNNING, ShowPhase.PAUSED)


def _step(
    name: StepName,
    confirmations: dict[StepName, Confirmation],
    *,
    to_do: tuple[Reason | None, ...] = (),
    to_confirm: tuple[Reason | None, ...] = (),
) -> Step:
    """Return a step with all its reasons; without any it is done."""
    open_reasons = tuple(reason for reason in to_do if reason is not None)
    doubts = tuple(reason for reason in to_confirm if reason is not None)
    status = StepStatus.TO_DO if open_reasons else StepStatus.TO_BE_CONFIRMED if doubts else StepStatus.DONE
    saved = confirmations.get(name)
    return Step(name, status, open_reasons + doubts, saved.at if saved else None, saved.by if saved else "")


def _moved(site: SiteState, saved: Confirmation | None) -> Reason | None:
    """Return that the location has changed since a step was saved (or that it was never saved for any)."""
    if saved is not None and saved.location_revision >= site.location_revision:
        return None
    return _LOCATION_MOVED


def _open(step: Step) -> Reason:
    number, what = list(StepName).index(step.name) + 1, step.name
    because = join(" ", (reason.message for reason in step.reasons))
    is_to_do = step.status is StepStatus.TO_DO
    message = (
        say("Step {number}, {what}, is to be done: {because}", number=number, what=what, because=because)
        if is_to_do
        else say(
            "Step {number}, {what}, is to be confirmed: {because}", number=number, what=what, because=because
        )
    )
    return Reason(f"step_{what}", message, say("Go to step {number}.", number=number))


def _home_lost(why: Message) -> Reason:
    return Reason(
        "home_lost",
        say("Home reference lost: {why}", why=why),
        N_("Point the panel to north and the horizon, then set the home position."),
    )


_LOCATION_UNKNOWN = Reason(
    "location_unknown",
    N_("The location has not been entered."),
    N_("Enter latitude and longitude and save them."),
)
_LOCATION_MOVED = Reason(
    "location_changed",
    N_("The location has changed since this step was saved."),
    N_("Check that the step is still correct, and confirm it."),
)
_CLOCK_UNSET = Reason(
    "clock_unset",
    N_("The clock has not been set."),
    N_("Set the clock, or keep the system clock, then save."),
)
_CLOCK_UNTRUSTED = Reason(
    "clock_untrusted",
    N_("The clock is not trusted."),
    N_("Compare the controller's clock with your own and save again."),
)
_HOME_UNSET = Reason(
    "home_unset",
    N_("The home position has not been set."),
    N_("Point the panel to north and the horizon, then press Set home here."),
)
_DRIVE_SILENT = Reason(
    "drive_unreachable",
    N_("The home position cannot be verified because the drive does not answer."),
    N_("Check the drive's power and its network cable."),
)
_MODE_UNSET = Reason(
    "mode_not_selected", N_("No mode has been selected."), N_("Choose one of the four modes.")
)
_NOT_THERE = Reason(
    "not_at_orientation",
    N_("The panel has not been at the orientation of this mode yet."),
    N_("Press Go and wait."),
)
_NOT_RUNNING = Reason(
    "not_running",
    N_("The tracker is not tracking, and no show is running."),
    N_("Press Start tracking, or open Show tracking movement."),
)
