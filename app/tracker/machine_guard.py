"""What the machine does that nobody asked for: creep, swapped axes, overrun, stuck switch, frozen counter."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

from app.tracker.activities.measuring import is_silent
from app.tracker.activity import Faulted, Homing, Jogging, SettingHome
from app.tracker.axes import Axis
from app.tracker.controller_state import ControllerState
from app.tracker.drive_tests import StopProof, StopSpeed
from app.tracker.guards import axis_feedback, pressed_switches
from app.tracker.interlocks import prompt
from app.tracker.machine_watch import (
    CROSSED_DEG,
    UNWATCHED,
    AxisGuard,
    Pressed,
    allowed_overrun_deg,
    beyond,
    braking,
    overrun_deg,
    pressed,
    rest,
    turning,
)
from app.tracker.motion import AxisCommand, DriveCommand, Feedback
from app.tracker.mounts.capabilities import axis_of
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.transitions import fail, leave, lose_home

CREEP_SHOWN = timedelta(seconds=60)
SLOW_STOPS = 3
"""So many stops must be as short as they should before an axis that overran turns at full speed again."""
TREND = 10
SUPPLY_FOR = timedelta(seconds=2)


def watch_machine(mind: ControllerState, before: Feedback | None, feedback: Feedback) -> None:
    """Judge the newest reading against what the axes were told, and latch what is a fault."""
    if isinstance(mind.activity, Jogging) and (slow := prompt(mind)) is not None:
        leave(mind, slow.message)
    told, was_told = mind.command, mind.told_before
    mind.told_before = told
    if before is feedback and mind.supply_since is None:
        return
    if before is not None and before is not feedback:
        exempt = _is_exempt(mind, before, feedback)
        mind.guards = {} if exempt else _watched(mind, before, feedback, was_told, told)
    for axis in mind.guards:
        _say_creep(mind, axis, feedback)
        _say_overrun(mind, axis, feedback)
    _watch_supply(mind, feedback)
    _latch(mind, feedback)


def _watched(
    mind: ControllerState, before: Feedback, feedback: Feedback, was_told: DriveCommand, told: DriveCommand
) -> dict[Axis, AxisGuard]:
    """Return the next state of everything that is watched."""
    return {
        axis: _seen(mind, axis, before, feedback, (_told(was_told, axis), _told(told, axis)))
        for axis in mind.config.mount.axes
    }


def _latch(mind: ControllerState, feedback: Feedback) -> None:
    """Fail for the first of the judges that objects; a fault stays the fault that it is."""
    if isinstance(mind.activity, Faulted):
        return
    for judge in JUDGES:
        reason = judge(mind, feedback)
        if reason is None:
            continue
        if reason.code in COST_THE_ZERO:
            lose_home(mind, reason)
        mind.guards = {}
        fail(mind, reason)
        return


def notices(mind: ControllerState) -> tuple[Reason, ...]:
    """Return what is watched and no fault: an axis that crept of late, and one that stops too late."""
    slow = prompt(mind)
    found: list[Reason] = [] if slow is None else [slow]
    if mind.seen is not None and mind.seen.feedback is not None:
        found.extend(pressed_switches(mind.config, mind.seen.feedback))
    for axis, guard in mind.guards.items():
        if guard.crept_at is not None and mind.now - guard.crept_at < CREEP_SHOWN:
            found.append(creeps(mind, axis))
        if guard.slow_stops_left:
            found.append(overruns(mind, axis, guard))
    return tuple(found)


def creeps(mind: ControllerState, axis: Axis) -> Reason:
    """Return that an axis turns though it should stand."""
    return Reason(
        "creep",
        f"Uncommanded motion of the {axis_of(mind.config, axis)}.",
        "Keep clear. Check the brake, and whether wind or another system moves the panel.",
    )


def overruns(mind: ControllerState, axis: Axis, guard: AxisGuard) -> Reason:
    """Return that an axis ran on for too long after a stop, and what it is allowed from now on."""
    return Reason(
        "overrun",
        f"The {axis_of(mind.config, axis)} needed {guard.overruns[-1]:.1f} degrees to stop, more "
        f"than its limit; its speed is reduced until {guard.slow_stops_left} more stops are within "
        "the limit.",
        "Check the brake and the load, then repeat the stop test on the Drive tests page.",
    )


def _is_exempt(mind: ControllerState, before: Feedback, feedback: Feedback) -> bool:
    """Return whether the axes may move as they like: search, zero, a test, hands at the cabinet, restart."""
    apart = isinstance(mind.activity, SettingHome | Homing) or feedback.homing or is_silent(mind)
    return apart or feedback.local or before.boot_count != feedback.boot_count or feedback.watchdog_tripped


def _seen(
    mind: ControllerState,
    axis: Axis,
    before: Feedback,
    feedback: Feedback,
    commands: tuple[AxisCommand, AxisCommand],
) -> AxisGuard:
    """Return the next state of everything that is watched of one axis."""
    guard, seen = mind.guards.get(axis, UNWATCHED), axis_feedback(feedback, axis)
    was_told, told = commands
    trusted = mind.memory.home is not None
    return replace(
        guard,
        rest=rest(guard.rest, told, seen, mind.now),
        braking=braking(guard.braking, told, was_told, axis_feedback(before, axis)),
        pressed=pressed(guard.pressed, seen),
        turning=turning(guard.turning, seen, mind.now),
        beyond=beyond(guard.beyond, mind.config.axis(axis), seen) if trusted else None,
    )


def _say_creep(mind: ControllerState, axis: Axis, feedback: Feedback) -> None:
    guard, seen = mind.guards[axis], axis_feedback(feedback, axis)
    if guard.rest is None or abs(guard.rest.crept_deg(seen)) <= mind.config.machine.creep_deg:
        return
    fresh = guard.crept_at is None or mind.now - guard.crept_at >= CREEP_SHOWN
    mind.guards = {
        **mind.guards,
        axis: replace(guard, rest=replace(guard.rest, position_deg=seen.position_deg), crept_at=mind.now),
    }
    if fresh:
        reason = creeps(mind, axis)
        mind.say(EventKind.UNCOMMANDED_MOTION, reason.message, code=reason.code, axis=axis)


def _say_overrun(mind: ControllerState, axis: Axis, feedback: Feedback) -> None:
    """Judge a stop: too long is said at once, and the axis is slow until its stops are short again."""
    guard, seen = mind.guards[axis], axis_feedback(feedback, axis)
    if guard.braking is None:
        return
    run_deg, config = overrun_deg(guard.braking, seen), mind.config.axis(axis)
    proof = _stop_proof(mind, axis)
    allowed = allowed_overrun_deg(guard.braking, config, proof, mind.config.machine.overrun_factor)
    if run_deg <= allowed and seen.moving:
        return
    ended = replace(guard, braking=None, overruns=(*guard.overruns, run_deg)[-TREND:])
    if run_deg <= allowed:
        ended = replace(ended, slow_stops_left=max(0, guard.slow_stops_left - 1))
    else:
        ended = replace(ended, slow_stops_left=SLOW_STOPS)
        mind.say(
            EventKind.STOPPING_DISTANCE_EXCEEDED,
            overruns(mind, axis, ended).message,
            code="overrun",
            axis=axis,
        )
    mind.guards = {**mind.guards, axis: ended}


def _stop_proof(mind: ControllerState, axis: Axis) -> StopProof | None:
    """Return the measured stop from the higher speed, if the drive is still the same."""
    proofs = (mind.memory.proofs.stop(axis, speed) for speed in (StopSpeed.RATED, StopSpeed.JOG))
    return next((one for one in proofs if one is not None and one.drive == mind.config.drive), None)


def _watch_supply(mind: ControllerState, feedback: Feedback) -> None:
    """Keep since when the supply is outside what the drive bears."""
    limits, volts = mind.config.machine, feedback.supply_v
    watched = volts is not None and limits.supply_high_v > 0.0
    outside = watched and volts is not None and not limits.supply_low_v <= volts <= limits.supply_high_v
    mind.supply_since = (mind.supply_since or mind.now) if outside else None


def _swapped(mind: ControllerState, feedback: Feedback) -> Reason | None:
    """Return that the wrong axis obeys: one that should stand turns, the one that was told does not."""
    for axis, guard in mind.guards.items():
        for other, commanded in mind.guards.items():
            resting, told = guard.rest, mind.watches.get(other)
            if other is axis or resting is None or told is None or commanded.rest is not None:
                continue
            crept_deg = abs(resting.crept_deg(axis_feedback(feedback, axis)))
            moved_deg = abs(axis_feedback(feedback, other).position_deg - told.turned_deg)
            if crept_deg > CROSSED_DEG and moved_deg < CROSSED_DEG / 3.0:
                return Reason(
                    "axes_swapped",
                    f"The {axis_of(mind.config, other)} was commanded, but the {axis_of(mind.config, axis)} "
                    "moves: the axes are swapped, or two drives have one address.",
                    "Check the unit ids and the motor cables of both axes, then reset the fault.",
                )
    return None


def _stuck_switch(mind: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in mind.guards.items():
        switch = guard.pressed
        if (
            switch is None
            or switch.left_deg(axis_feedback(feedback, axis)) <= mind.config.machine.switch_way_deg
        ):
            continue
        return Reason(
            "limit_stuck",
            f"The {_end(switch)} limit switch of the {axis_of(mind.config, axis)} stays on although the axis "
            f"has left it by {switch.left_deg(axis_feedback(feedback, axis)):.0f} degrees.",
            "Check the switch and its cable, then reset the fault. The axis may move away from the switch.",
        )
    return None


def _frozen(mind: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in mind.guards.items():
        if guard.turning is not None and guard.turning.is_frozen():
            return Reason(
                "position_frozen",
                (
                    f"The position of the {axis_of(mind.config, axis)} is frozen although the drive "
                    "reports motion."
                ),
                (
                    "Check the encoder and its cable, reset the fault, then set the home position "
                    "again in step 3."
                ),
            )
    return None


def _over_travel(mind: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in mind.guards.items():
        outside_deg = mind.config.axis(axis).beyond_deg(axis_feedback(feedback, axis).position_deg)
        if guard.beyond is None or outside_deg - guard.beyond.least_deg <= mind.config.machine.overtravel_deg:
            continue
        unseen = ", and no limit switch was reached" if mind.capabilities.limit_switches else ""
        return Reason(
            "over_travel",
            f"The {axis_of(mind.config, axis)} has left its soft limits by {outside_deg:.1f} degrees"
            f"{unseen}.",
            (
                "Find out why the axis did not stop. Reset the fault, then set the home position "
                "again in step 3, Homing."
            ),
        )
    return None


def _supply(mind: ControllerState, feedback: Feedback) -> Reason | None:
    if mind.supply_since is None or mind.now - mind.supply_since < SUPPLY_FOR or feedback.supply_v is None:
        return None
    limits = mind.config.machine
    return Reason(
        "supply_voltage",
        f"The supply of the drive of {mind.config.name} is at {feedback.supply_v:.1f} V; it must lie between "
        f"{limits.supply_low_v:g} and {limits.supply_high_v:g} V.",
        "Check the supply and its cables, then reset the fault.",
    )


def _end(switch: Pressed) -> str:
    return "upper" if switch.upper else "lower"


def _told(command: DriveCommand, axis: Axis) -> AxisCommand:
    return command.azimuth if axis is Axis.AZIMUTH else command.elevation


JUDGES: tuple[Callable[[ControllerState, Feedback], Reason | None], ...] = (
    _swapped,
    _stuck_switch,
    _frozen,
    _over_travel,
    _supply,
)
COST_THE_ZERO = frozenset({"position_frozen", "over_travel"})
"""As OnStepX has it: an encoder fault and over-travel end the trust in the zero, an ordinary stop not."""
