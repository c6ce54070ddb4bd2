"""What the machine does that nobody asked for: creep, swapped axes, overrun, stuck switch, frozen counter."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, Word, say, with_format
from app.tracker.access.interlocks import prompt
from app.tracker.memory.drive_tests import StopProof, StopSpeed
from app.tracker.motion.guards import axis_feedback, pressed_switches
from app.tracker.motion.machine_watch import (
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
from app.tracker.mounts.capabilities import axis_of
from app.tracker.settings.axes import Axis
from app.tracker.state.activity import Faulted, Homing, Jogging, Measuring, SettingHome
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.home_trust import lose_home
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import fail, leave
from app.tracker.values.motion import AxisCommand, DriveCommand, Feedback
from app.tracker.values.reason import Reason

CREEP_SHOWN = timedelta(seconds=60)
SLOW_STOPS = 3
"""So many stops must be as short as they should before an axis that overran turns at full speed again."""
TREND = 10
SUPPLY_FOR = timedelta(seconds=2)


def is_silent(state: ControllerState) -> bool:
    """Return whether the drive is told nothing: after the last command of a link-loss test."""
    activity = state.activity
    if not isinstance(activity, Measuring) or activity.speed is not None or activity.asked is None:
        return False
    return state.now > activity.asked.at


def watch_machine(state: ControllerState, before: Feedback | None, feedback: Feedback) -> None:
    """Judge the newest reading against what the axes were told, and latch what is a fault."""
    if isinstance(state.activity, Jogging) and (slow := prompt(state)) is not None:
        leave(state, slow.message)
    told, was_told = state.command, state.told_before
    state.told_before = told
    if before is feedback and state.supply_since is None:
        return
    if before is not None and before is not feedback:
        exempt = _is_exempt(state, before, feedback)
        state.guards = {} if exempt else _watched(state, before, feedback, was_told, told)
    for axis in state.guards:
        _say_creep(state, axis, feedback)
        _say_overrun(state, axis, feedback)
    _watch_supply(state, feedback)
    _latch(state, feedback)


def forget_guards(state: ControllerState) -> None:
    """Begin anew to judge what the axes do."""
    state.guards = {}


def _watched(
    state: ControllerState, before: Feedback, feedback: Feedback, was_told: DriveCommand, told: DriveCommand
) -> dict[Axis, AxisGuard]:
    """Return the next state of everything that is watched."""
    return {
        axis: _seen(state, axis, before, feedback, (_told(was_told, axis), _told(told, axis)))
        for axis in state.config.mount.axes
    }


def _latch(state: ControllerState, feedback: Feedback) -> None:
    """Fail for the first of the judges that objects; a fault stays the fault that it is."""
    if isinstance(state.activity, Faulted):
        return
    for judge in JUDGES:
        reason = judge(state, feedback)
        if reason is None:
            continue
        if reason.code in COST_THE_ZERO:
            lose_home(state, reason)
        state.guards = {}
        fail(state, reason)
        return


def notices(state: ControllerState) -> tuple[Reason, ...]:
    """Return what is watched and no fault: an axis that crept of late, and one that stops too late."""
    slow = prompt(state)
    found: list[Reason] = [] if slow is None else [slow]
    if state.seen is not None and state.seen.feedback is not None:
        found.extend(pressed_switches(state.config, state.seen.feedback))
    for axis, guard in state.guards.items():
        if guard.crept_at is not None and state.now - guard.crept_at < CREEP_SHOWN:
            found.append(creeps(state, axis))
        if guard.slow_stops_left:
            found.append(overruns(state, axis, guard))
    return tuple(found)


def creeps(state: ControllerState, axis: Axis) -> Reason:
    """Return that an axis turns though it should stand."""
    return Reason(
        "creep",
        say("Uncommanded motion of the {config}.", config=axis_of(state.config, axis)),
        N_("Keep clear. Check the brake, and whether wind or another system moves the panel."),
    )


def overruns(state: ControllerState, axis: Axis, guard: AxisGuard) -> Reason:
    """Return that an axis ran on for too long after a stop, and what it is allowed from now on."""
    return Reason(
        "overrun",
        say(
            "The {config} needed {overruns} degrees to stop, more than its limit; its speed is "
            "reduced until {slow_stops_left} more stops are within the limit.",
            config=axis_of(state.config, axis),
            overruns=with_format(guard.overruns[-1], ".1f"),
            slow_stops_left=guard.slow_stops_left,
        ),
        N_("Check the brake and the load, then repeat the stop test on the Drive tests page."),
    )


def _is_exempt(state: ControllerState, before: Feedback, feedback: Feedback) -> bool:
    """Return whether the axes may move as they like: search, zero, a test, hands at the cabinet, restart."""
    apart = isinstance(state.activity, SettingHome | Homing) or feedback.homing or is_silent(state)
    return apart or feedback.local or before.boot_count != feedback.boot_count or feedback.watchdog_tripped


def _seen(
    state: ControllerState,
    axis: Axis,
    before: Feedback,
    feedback: Feedback,
    commands: tuple[AxisCommand, AxisCommand],
) -> AxisGuard:
    """Return the next state of everything that is watched of one axis."""
    guard, seen = state.guards.get(axis, UNWATCHED), axis_feedback(feedback, axis)
    was_told, told = commands
    trusted = state.memory.home is not None
    return replace(
        guard,
        rest=rest(guard.rest, told, seen, state.now),
        braking=braking(guard.braking, told, was_told, axis_feedback(before, axis)),
        pressed=pressed(guard.pressed, seen),
        turning=turning(guard.turning, seen, state.now),
        beyond=beyond(guard.beyond, state.config.axis(axis), seen) if trusted else None,
    )


def _say_creep(state: ControllerState, axis: Axis, feedback: Feedback) -> None:
    guard, seen = state.guards[axis], axis_feedback(feedback, axis)
    if guard.rest is None or abs(guard.rest.crept_deg(seen)) <= state.config.machine.creep_deg:
        return
    fresh = guard.crept_at is None or state.now - guard.crept_at >= CREEP_SHOWN
    state.guards = {
        **state.guards,
        axis: replace(guard, rest=replace(guard.rest, position_deg=seen.position_deg), crept_at=state.now),
    }
    if fresh:
        reason = creeps(state, axis)
        state.say(EventKind.UNCOMMANDED_MOTION, reason.message, code=reason.code, axis=axis)


def _say_overrun(state: ControllerState, axis: Axis, feedback: Feedback) -> None:
    """Judge a stop: too long is said at once, and the axis is slow until its stops are short again."""
    guard, seen = state.guards[axis], axis_feedback(feedback, axis)
    if guard.braking is None:
        return
    run_deg, config = overrun_deg(guard.braking, seen), state.config.axis(axis)
    proof = _stop_proof(state, axis)
    allowed = allowed_overrun_deg(guard.braking, config, proof, state.config.machine.overrun_factor)
    if run_deg <= allowed and seen.moving:
        return
    ended = replace(guard, braking=None, overruns=(*guard.overruns, run_deg)[-TREND:])
    if run_deg <= allowed:
        ended = replace(ended, slow_stops_left=max(0, guard.slow_stops_left - 1))
    else:
        ended = replace(ended, slow_stops_left=SLOW_STOPS)
        state.say(
            EventKind.STOPPING_DISTANCE_EXCEEDED,
            overruns(state, axis, ended).message,
            code="overrun",
            axis=axis,
        )
    state.guards = {**state.guards, axis: ended}


def _stop_proof(state: ControllerState, axis: Axis) -> StopProof | None:
    """Return the measured stop from the higher speed, if the drive is still the same."""
    proofs = (state.memory.proofs.stop(axis, speed) for speed in (StopSpeed.RATED, StopSpeed.JOG))
    return next((one for one in proofs if one is not None and one.drive == state.config.drive), None)


def _watch_supply(state: ControllerState, feedback: Feedback) -> None:
    """Keep since when the supply is outside what the drive bears."""
    limits, volts = state.config.machine, feedback.supply_v
    watched = volts is not None and limits.supply_high_v > 0.0
    outside = watched and volts is not None and not limits.supply_low_v <= volts <= limits.supply_high_v
    state.supply_since = (state.supply_since or state.now) if outside else None


def _swapped(state: ControllerState, feedback: Feedback) -> Reason | None:
    """Return that the wrong axis obeys: one that should stand turns, the one that was told does not."""
    for axis, guard in state.guards.items():
        for other, commanded in state.guards.items():
            resting, told = guard.rest, state.watches.get(other)
            if other is axis or resting is None or told is None or commanded.rest is not None:
                continue
            crept_deg = abs(resting.crept_deg(axis_feedback(feedback, axis)))
            moved_deg = abs(axis_feedback(feedback, other).position_deg - told.turned_deg)
            if crept_deg > CROSSED_DEG and moved_deg < CROSSED_DEG / 3.0:
                return Reason(
                    "axes_swapped",
                    say(
                        "The {config} was commanded, but the {config2} moves: the axes are swapped, or two "
                        "drives have one address.",
                        config=axis_of(state.config, other),
                        config2=axis_of(state.config, axis),
                    ),
                    N_("Check the unit ids and the motor cables of both axes, then reset the fault."),
                )
    return None


def _stuck_switch(state: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in state.guards.items():
        switch = guard.pressed
        if (
            switch is None
            or switch.left_deg(axis_feedback(feedback, axis)) <= state.config.machine.switch_way_deg
        ):
            continue
        return Reason(
            "limit_stuck",
            say(
                "The {switch} limit switch of the {config} stays on although the axis has left it by "
                "{left_deg} degrees.",
                switch=Word(_end(switch)),
                config=axis_of(state.config, axis),
                left_deg=with_format(switch.left_deg(axis_feedback(feedback, axis)), ".0f"),
            ),
            N_(
                "Check the switch and its cable, then reset the fault. The axis may move away "
                "from the switch."
            ),
        )
    return None


def _frozen(state: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in state.guards.items():
        if guard.turning is not None and guard.turning.is_frozen():
            return Reason(
                "position_frozen",
                (
                    say(
                        "The position of the {config} is frozen although the drive reports motion.",
                        config=axis_of(state.config, axis),
                    )
                ),
                N_(
                    "Check the encoder and its cable, reset the fault, then set the home position "
                    "again in step 3."
                ),
            )
    return None


def _over_travel(state: ControllerState, feedback: Feedback) -> Reason | None:
    for axis, guard in state.guards.items():
        outside_deg = state.config.axis(axis).beyond_deg(axis_feedback(feedback, axis).position_deg)
        if (
            guard.beyond is None
            or outside_deg - guard.beyond.least_deg <= state.config.machine.overtravel_deg
        ):
            continue
        unseen = N_(", and no limit switch was reached") if state.capabilities.limit_switches else ""
        return Reason(
            "over_travel",
            say(
                "The {config} has left its soft limits by {outside_deg} degrees{unseen}.",
                config=axis_of(state.config, axis),
                outside_deg=with_format(outside_deg, ".1f"),
                unseen=unseen,
            ),
            N_(
                "Find out why the axis did not stop. Reset the fault, then set the home position "
                "again in step 3, Homing."
            ),
        )
    return None


def _supply(state: ControllerState, feedback: Feedback) -> Reason | None:
    if state.supply_since is None or state.now - state.supply_since < SUPPLY_FOR or feedback.supply_v is None:
        return None
    limits = state.config.machine
    return Reason(
        "supply_voltage",
        say(
            "The supply of the drive of {name} is at {supply_v} V; it must lie between "
            "{supply_low_v} and {supply_high_v} V.",
            name=state.config.name,
            supply_v=with_format(feedback.supply_v, ".1f"),
            supply_low_v=with_format(limits.supply_low_v, "g"),
            supply_high_v=with_format(limits.supply_high_v, "g"),
        ),
        N_("Check the supply and its cables, then reset the fault."),
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
