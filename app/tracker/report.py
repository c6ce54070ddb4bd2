"""What the last tick looked like: the snapshot for people, the frame for recordings."""

from datetime import datetime
from math import nan

from app.angles import separation_deg, wrap360
from app.sun.position import SunPosition
from app.tracker import machine_guard
from app.tracker.activities.tracking import sun_height_deg
from app.tracker.activity import (
    NAMES,
    AxisPair,
    Faulted,
    Homing,
    Showing,
    Stowed,
    Stowing,
    Tracking,
    TrackPhase,
)
from app.tracker.approach import is_approaching
from app.tracker.authority import service_state
from app.tracker.commissioning import Standing
from app.tracker.config import MountKind, Orientation, TrackerConfig
from app.tracker.controller_state import ControllerState
from app.tracker.home_shift import is_undone
from app.tracker.hybrid import Corrected
from app.tracker.interlocks import Action, reachable, undoable, unmet
from app.tracker.motion import AxisFeedback, Feedback, Position
from app.tracker.mount import sky
from app.tracker.mounts.capabilities import default_mode
from app.tracker.positioning import arrived, at_rest, close_to
from app.tracker.progress import step_progress
from app.tracker.protections.words import WarningState
from app.tracker.reason import Reason
from app.tracker.rejected import accepted
from app.tracker.sensors import sensors
from app.tracker.snapshot import ActivityName, AxisState, HybridState, Pair, ShowPhase, ShowProgress, Snapshot
from app.tracker.weather import NOTHING_SENSED
from app.tracker.weather_protection import doubts, hold_reason, protection_state, reason
from app.tracker.words import activity_text

_INDEX = {kind: float(list(ActivityName).index(name)) for kind, name in NAMES.items()}
_NO_ORIENTATION = (nan, nan)


def snapshot(mind: ControllerState, at: datetime, now: datetime, *, asked: bool = True) -> Snapshot:
    """Return what is known after the last tick, stamped `at`; ages count to `now`; actions if `asked`."""
    fresh = mind.seen.feedback if mind.seen else None
    faced = _faced(mind, fresh)
    sun_is_up = mind.sun is not None and sun_height_deg(mind.config, mind.sun) > 0.0
    return Snapshot(
        tracker_id=mind.config.tracker_id,
        name=mind.config.name,
        at=at,
        tick=mind.ticks,
        activity=NAMES[type(mind.activity)],
        activity_text=activity_text(mind),
        approaching=is_approaching(mind),
        mode=mind.memory.mode or default_mode(mind.config.mount),
        orientation=mind.memory.orientation,
        tracking_on=mind.memory.tracking_on,
        sun=mind.sun,
        sun_is_up=sun_is_up,
        target=_pair(mind.target),
        setpoint=_setpoint(mind),
        measured=_pair(faced),
        last_measured=_pair(_faced(mind, mind.feedback)),
        position_age_s=(now - mind.feedback_at).total_seconds() if mind.feedback_at else None,
        following_error_deg=_following_error_deg(mind),
        off_sun_deg=_off_deg(mind.config, _uncorrected(mind, fresh), mind.sun) if sun_is_up else None,
        in_position=_in_position(mind, fresh),
        home_trusted=mind.memory.home is not None,
        azimuth=_axis_state(mind, fresh.azimuth) if fresh else None,
        elevation=_axis_state(mind, fresh.elevation) if fresh and not mind.config.mount.single_axis else None,
        fault=mind.activity.reason if isinstance(mind.activity, Faulted) else None,
        waiting=_waiting(mind),
        notices=_notices(mind),
        show=_show(mind.activity) if isinstance(mind.activity, Showing) else None,
        program=step_progress(mind),
        hybrid=_hybrid(mind, fresh),
        actions={action.value: unmet(mind, action) for action in Action} if asked else {},
        unreachable=reachable(mind),
        protection=protection_state(mind),
        stow=mind.activity.stow if isinstance(mind.activity, Stowing | Stowed) else None,
        not_stowed=mind.alarmed,
        warning=_warning(mind),
        lock=mind.memory.lock,
        settings_lock=mind.memory.settings_lock,
        sensors=sensors(mind),
        local=fresh is not None and fresh.local,
        service=service_state(mind),
        link=mind.seen.link if mind.seen else None,
        home=mind.memory.home,
        home_lost=mind.memory.home_lost,
        home_lost_at=mind.memory.home_lost_at,
        can_undo_home=undoable(mind) is None,
        rejected=mind.memory.rejected,
    )


def standing(mind: ControllerState) -> Standing:
    """Return what the five steps go by: the same as `standing_of` a snapshot, at a tenth of the cost."""
    match mind.activity:
        case Tracking():
            runs = True
        case Stowing() | Stowed():
            runs = mind.memory.tracking_on
        case Showing(phase=phase):
            runs = phase in (ShowPhase.RUNNING, ShowPhase.PAUSED)
        case _:
            runs = False
    seen = mind.seen is not None and mind.seen.feedback is not None
    return Standing(seen, runs, () if runs else _waiting(mind))


def frame(mind: ControllerState) -> tuple[float, ...]:
    """Return the last tick in the order of `recording.COLUMNS`; elapsed and sun time are NaN."""
    sun, target = mind.sun, mind.target
    feedback = mind.seen.feedback if mind.seen else None
    return (
        nan,
        nan,
        *(_NO_ORIENTATION if sun is None else (sun.azimuth_deg, sun_height_deg(mind.config, sun))),
        *(_NO_ORIENTATION if target is None else (target.azimuth_deg, target.elevation_deg)),
        *_told(mind),
        *_stands(mind, feedback),
        *_corrections(mind),
        *_drive(feedback),
        *_weather(mind),
        _INDEX[type(mind.activity)],
    )


def _drive(feedback: Feedback | None) -> tuple[float, float, float]:
    """Return the speed of both axes and the voltage of the supply, as the drive tells them."""
    if feedback is None:
        return nan, nan, nan
    supply_v = nan if feedback.supply_v is None else feedback.supply_v
    return feedback.azimuth.velocity_dps, feedback.elevation.velocity_dps, supply_v


def _weather(mind: ControllerState) -> tuple[float, float, float]:
    """Return gust, mean wind and light of this tick, to what a station resolves; NaN what is not good."""
    if mind.seen is None or mind.seen.weather is NOTHING_SENSED:
        return nan, nan, nan
    told = mind.seen.weather
    values = (told.wind.good, told.wind_mean_mps, told.light.good)
    gust_mps, mean_mps, light_wm2 = (nan if value is None else round(value, 1) for value in values)
    return gust_mps, mean_mps, light_wm2


def _told(mind: ControllerState) -> tuple[float, float]:
    """Return the set-point: of the axes on an azimuth-elevation mount, else of the sky."""
    if mind.config.mount.kind is not MountKind.AZIMUTH_ELEVATION:
        told = _setpoint(mind)
        return _NO_ORIENTATION if told is None else (told.azimuth_deg, told.elevation_deg)
    azimuth_deg, elevation_deg = mind.setpoint.azimuth_deg, mind.setpoint.elevation_deg
    return (
        nan if azimuth_deg is None else wrap360(azimuth_deg),
        nan if elevation_deg is None else elevation_deg,
    )


def _stands(mind: ControllerState, feedback: Feedback | None) -> tuple[float, float]:
    """Return where the panel stands: axis angles on an azimuth-elevation mount, else its direction."""
    if feedback is None:
        return _NO_ORIENTATION
    if mind.config.mount.kind is not MountKind.AZIMUTH_ELEVATION:
        faced = _faced(mind, feedback)
        return _NO_ORIENTATION if faced is None else (faced.azimuth_deg, faced.elevation_deg)
    return wrap360(feedback.azimuth.position_deg), feedback.elevation.position_deg


def _corrections(mind: ControllerState) -> tuple[float, float]:
    """Return what the light sensors add to the computed axis angles."""
    corrected = _correction(mind)
    if corrected is None:
        return 0.0, 0.0
    return corrected.azimuth.degrees, corrected.elevation.degrees


def _faced(mind: ControllerState, feedback: Feedback | None) -> Orientation | None:
    if feedback is None:
        return None
    return sky(
        mind.config, mind.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )


def _uncorrected(mind: ControllerState, feedback: Feedback | None) -> Orientation | None:
    """Return where the panel faces, the pointing error that the light sensors found taken out."""
    corrected = _correction(mind)
    if feedback is None or corrected is None:
        return _faced(mind, feedback)
    return sky(
        mind.config,
        mind.memory.pointing,
        feedback.azimuth.position_deg - corrected.azimuth.degrees,
        feedback.elevation.position_deg - corrected.elevation.degrees,
    )


def _correction(mind: ControllerState) -> Corrected | None:
    return mind.corrected if mind.config.hybrid.enabled and isinstance(mind.activity, Tracking) else None


def _hybrid(mind: ControllerState, feedback: Feedback | None) -> HybridState | None:
    corrected = _correction(mind)
    if corrected is None:
        return None
    return HybridState(
        computed=Pair(corrected.computed.azimuth_deg, corrected.computed.elevation_deg),
        correction=Pair(corrected.azimuth.degrees, corrected.elevation.degrees),
        sum=Pair(corrected.target.azimuth_deg, corrected.target.elevation_deg),
        azimuth_phase=corrected.azimuth.phase,
        elevation_phase=corrected.elevation.phase,
        light=feedback.light if feedback else None,
    )


def _pair(orientation: Orientation | None) -> Pair | None:
    return None if orientation is None else Pair(orientation.azimuth_deg, orientation.elevation_deg)


def _setpoint(mind: ControllerState) -> Pair | None:
    """Return what the drive was told, in the sky; an axis that was told nothing counts where it is."""
    azimuth_deg, elevation_deg = mind.setpoint.azimuth_deg, mind.setpoint.elevation_deg
    feedback = mind.feedback
    if feedback is None or (azimuth_deg is None and elevation_deg is None):
        return None
    azimuth_deg = feedback.azimuth.position_deg if azimuth_deg is None else azimuth_deg
    elevation_deg = feedback.elevation.position_deg if elevation_deg is None else elevation_deg
    return _pair(sky(mind.config, mind.memory.pointing, azimuth_deg, elevation_deg))


def _off_deg(config: TrackerConfig, faced: Orientation | None, sun: SunPosition | None) -> float | None:
    if faced is None or sun is None:
        return None
    height_deg = sun_height_deg(config, sun)
    return separation_deg(faced.azimuth_deg, faced.elevation_deg, sun.azimuth_deg, height_deg)


def _following_error_deg(mind: ControllerState) -> float | None:
    """Return by how much the axis that follows worst differs from its reference; None while none moves."""
    return max((watched.error_deg for watched in mind.watches.values()), key=abs, default=None)


def _in_position(mind: ControllerState, feedback: Feedback | None) -> bool:
    if feedback is None:
        return False
    if isinstance(mind.activity, Tracking) and isinstance(mind.command.azimuth, Position):
        return mind.activity.run is None and close_to(mind.setpoint, feedback, mind.config.in_position_deg)
    if not at_rest(feedback):
        return False
    if isinstance(mind.activity, Tracking):
        return mind.activity.run is None and mind.activity.phase is not TrackPhase.PAUSED
    if mind.setpoint == AxisPair(None, None):
        return False
    return arrived(mind.setpoint, feedback, mind.config.in_position_deg)


def _axis_state(mind: ControllerState, axis: AxisFeedback) -> AxisState:
    """Return an axis as it is shown; a drive goes on saying that it is homed where that was undone."""
    return AxisState(
        moving=axis.moving,
        homed=axis.homed and not is_undone(mind),
        at_lower_limit=axis.at_lower_limit,
        at_upper_limit=axis.at_upper_limit,
        at_origin=axis.at_origin,
        position_deg=axis.position_deg,
    )


def _waiting(mind: ControllerState) -> tuple[Reason, ...]:
    """Return why a tracker that should track does not move, a cause that two conditions share once."""
    if isinstance(mind.activity, Tracking):
        rests = hold_reason(mind) if mind.activity.phase is TrackPhase.RESTING else None
        return _HOLDS.get(mind.activity.phase, ()) if rests is None else (rests,)
    if isinstance(mind.activity, Stowing | Stowed):
        return _stowed(mind)
    if not mind.memory.tracking_on:
        return () if mind.memory.stow is None or mind.wait is None else (mind.wait,)
    known = () if mind.wait is None else (mind.wait,)
    codes = {reason.code for reason in known}
    if codes & _SENT_TO_HOMING and mind.wait is not None and mind.wait.message == mind.memory.home_lost:
        codes.add("home_not_trusted")
    others = tuple(reason for reason in unmet(mind, Action.TRACK) if reason.code not in codes)
    return known + others or (_OPERATOR,)


def _stowed(mind: ControllerState) -> tuple[Reason, ...]:
    """Return why a stowed tracker that should track does not."""
    if not mind.memory.tracking_on:
        return ()
    by_weather = mind.guarding is not None and mind.guarding.stow is not None
    return (reason(mind) if by_weather else _STOWED,)


def _warning(mind: ControllerState) -> WarningState | None:
    """Return the countdown to a motion, or to the end of one by hand."""
    if mind.hand_until is not None:
        return WarningState(max(0.0, (mind.hand_until - mind.now).total_seconds()), _HAND_ENDS)
    if mind.warning is None:
        return None
    return WarningState(max(0.0, (mind.warning.until - mind.now).total_seconds()), mind.warning.reason)


def _notices(mind: ControllerState) -> tuple[Reason, ...]:
    """Return what is worth knowing but forbids nothing."""
    limited = isinstance(mind.activity, Tracking) and mind.activity.phase is TrackPhase.LIMITED
    found = (
        (mind.memory.home is None, _NO_SOFT_LIMITS),
        (limited, _LIMITED),
        (mind.capabilities.watchdog_s is None, _NO_WATCHDOG),
        (not mind.capabilities.verified, _UNVERIFIED),
    )
    refused = accepted(mind)
    told = tuple(reason for reason in (refused, mind.aftermath) if reason is not None)
    if mind.memory.home is None and mind.memory.home_lost and not isinstance(mind.activity, Homing):
        told = (*told, _zero_lost(mind))
    return (
        told
        + machine_guard.notices(mind)
        + doubts(mind)
        + tuple(reason for present, reason in found if present)
    )


def _zero_lost(mind: ControllerState) -> Reason:
    return Reason(
        "home_lost",
        f"{mind.config.name} is no longer homed: {mind.memory.home_lost}",
        "Compare the panel with the angles shown, then set the home position again in step 3, Homing.",
    )


def _show(showing: Showing) -> ShowProgress:
    plan, seen = showing.course.plan, showing.course.at(showing.elapsed)
    return ShowProgress(
        show_id=plan.show_id,
        phase=showing.phase,
        sun_time=seen.sun_time,
        elapsed_s=showing.elapsed.total_seconds(),
        duration_s=plan.duration.total_seconds(),
        acceleration=plan.acceleration,
        begin_at=plan.begin_at,
        end_at=plan.end_at,
        sun_is_up=seen.sun_is_up,
    )


_SUN_DOWN = Reason(
    "sun_down", "The sun is below the horizon.", "Tracking continues automatically at sunrise."
)
_CLOCK_DOUBTED = Reason(
    "clock_untrusted",
    "The site's clock is not trusted.",
    "Confirm the clock in step 2, or wait until it has been stable for 60 s; then tracking continues.",
)
_HOLDS = {TrackPhase.NIGHT: (_SUN_DOWN,), TrackPhase.PAUSED: (_CLOCK_DOUBTED,)}
_SENT_TO_HOMING = frozenset({"drive_restarted", "not_homed", "encoder_jump"})
"""Reasons to wait that say by themselves that the zero is lost, and to set it again."""
_STOWED = Reason("stowed", "The panel was stowed manually.", "Press Resume, or Start tracking.")
_HAND_ENDS = Reason(
    "hand_motion_ends",
    "Wind or snow requires a stow; this jog ends.",
    "Release the button and move away from the panel, or press again for a few more seconds.",
)
_OPERATOR = Reason(
    "operator_needed", "Tracking was interrupted and needs the operator.", "Press Start tracking."
)
_NO_SOFT_LIMITS = Reason(
    "no_soft_limits",
    (
        "The tracker is not homed, so the soft limits do not protect it: only the limit switches and "
        "the operator do."
    ),
    "Watch the panel while you move it, and set the home position in step 3, Homing.",
)
_LIMITED = Reason(
    "limited",
    "The sun is beyond the range of the axes; the panel faces it as nearly as they allow.",
    "No action is needed; the soft limits are in the tracker's settings.",
)
_NO_WATCHDOG = Reason(
    "no_watchdog",
    "This drive does not stop on communication loss, so jogging is limited to short increments.",
    "Keep the emergency stop within reach.",
)
_UNVERIFIED = Reason(
    "profile_unverified",
    "The profile of this drive has not been verified on a real drive.",
    "Carefully test every motion and the stop before you rely on this drive.",
)
