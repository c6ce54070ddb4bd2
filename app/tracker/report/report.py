"""What the last tick looked like: the snapshot for people, the frame for recordings."""

from datetime import datetime
from math import nan
from typing import Any

from app.base.angles import separation_deg, wrap360
from app.tracker.access.authority import service_state
from app.tracker.access.continuing import goes_on
from app.tracker.access.interlocks import Action, reachable, undoable, unmet
from app.tracker.activities.approach import is_approaching
from app.tracker.activities.tracking import sun_height_deg
from app.tracker.commissioning.steps import Standing
from app.tracker.motion.hybrid import Corrected
from app.tracker.mounts.capabilities import default_mode
from app.tracker.mounts.mount import sky
from app.tracker.report.activity_texts import activity_text
from app.tracker.report.progress import step_progress
from app.tracker.report.shown_reasons import countdown, notices, waiting_reasons
from app.tracker.settings.config import MountKind, Orientation
from app.tracker.state.activity import (
    NAMES,
    Faulted,
    Showing,
    Stowed,
    Stowing,
    Tracking,
    TrackPhase,
)
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.parts import NOWHERE
from app.tracker.state.positioning import arrived, at_rest, close_to
from app.tracker.state.snapshot import (
    ActivityName,
    AxisState,
    HybridState,
    Pair,
    ShowPhase,
    ShowProgress,
    Snapshot,
)
from app.tracker.supervision.home_shift import is_undone
from app.tracker.supervision.sensors import sensors
from app.tracker.supervision.weather_protection import protection_state
from app.tracker.values.motion import AxisFeedback, Feedback, Position
from app.tracker.weather.weather import NOTHING_SENSED

_INDEX = {kind: float(list(ActivityName).index(name)) for kind, name in NAMES.items()}
_NO_ORIENTATION = (nan, nan)


def snapshot(state: ControllerState, at: datetime, now: datetime, *, asked: bool = True) -> Snapshot:
    """Return what is known after the last tick, stamped `at`; ages count to `now`; actions if `asked`."""
    fresh = state.seen.feedback if state.seen else None
    return Snapshot(
        tracker_id=state.config.tracker_id,
        name=state.config.name,
        at=at,
        tick=state.ticks,
        activity=NAMES[type(state.activity)],
        activity_text=activity_text(state),
        approaching=is_approaching(state),
        continues=goes_on(state),
        mode=state.memory.mode or default_mode(state.config.mount),
        orientation=state.memory.orientation,
        tracking_on=state.memory.tracking_on,
        sun=state.sun,
        sun_is_up=_sun_is_up(state),
        target=_pair(state.target),
        setpoint=_setpoint(state),
        measured=_pair(_faced(state, fresh)),
        last_measured=_pair(_faced(state, state.feedback)),
        position_age_s=(now - state.feedback_at).total_seconds() if state.feedback_at else None,
        following_error_deg=_following_error_deg(state),
        off_sun_deg=_off_sun_deg(state, fresh),
        in_position=_in_position(state, fresh),
        azimuth=_axis_state(state, fresh.azimuth) if fresh else None,
        elevation=_elevation_state(state, fresh),
        fault=state.activity.reason if isinstance(state.activity, Faulted) else None,
        waiting=waiting_reasons(state),
        notices=notices(state),
        show=_show(state.activity) if isinstance(state.activity, Showing) else None,
        program=step_progress(state),
        hybrid=_hybrid(state, fresh),
        actions={action.value: unmet(state, action) for action in Action} if asked else {},
        unreachable=reachable(state),
        protection=protection_state(state),
        stow=state.activity.stow if isinstance(state.activity, Stowing | Stowed) else None,
        not_stowed=state.alarmed,
        warning=countdown(state),
        lock=state.memory.lock,
        settings_lock=state.memory.settings_lock,
        sensors=sensors(state),
        local=fresh is not None and fresh.local,
        service=service_state(state),
        link=state.seen.link if state.seen else None,
        rejected=state.memory.rejected,
        **_home(state),
    )


def _home(state: ControllerState) -> dict[str, Any]:
    """Return what a snapshot tells of the home position."""
    memory = state.memory
    return {
        "homed": memory.home is not None,
        "home": memory.home,
        "home_lost": memory.home_lost,
        "home_lost_at": memory.home_lost_at,
        "can_undo_home": undoable(state) is None,
    }


def standing(state: ControllerState) -> Standing:
    """Return what the five steps go by: the same as `standing_of` a snapshot, at a tenth of the cost."""
    match state.activity:
        case Tracking():
            runs = True
        case Stowing() | Stowed():
            runs = state.memory.tracking_on
        case Showing(phase=phase):
            runs = phase in (ShowPhase.RUNNING, ShowPhase.PAUSED)
        case _:
            runs = False
    seen = state.seen is not None and state.seen.feedback is not None
    return Standing(seen, runs, () if runs else waiting_reasons(state))


def frame(state: ControllerState) -> tuple[float, ...]:
    """Return the last tick in the order of `recording.COLUMNS`; elapsed and sun time are NaN."""
    sun, target = state.sun, state.target
    feedback = state.seen.feedback if state.seen else None
    return (
        nan,
        nan,
        *(_NO_ORIENTATION if sun is None else (sun.azimuth_deg, sun_height_deg(state.config, sun))),
        *(_NO_ORIENTATION if target is None else (target.azimuth_deg, target.elevation_deg)),
        *_told(state),
        *_stands(state, feedback),
        *_corrections(state),
        *_drive(feedback),
        *_weather(state),
        _INDEX[type(state.activity)],
    )


def _drive(feedback: Feedback | None) -> tuple[float, float, float]:
    """Return the speed of both axes and the voltage of the supply, as the drive tells them."""
    if feedback is None:
        return nan, nan, nan
    supply_v = nan if feedback.supply_v is None else feedback.supply_v
    return feedback.azimuth.velocity_dps, feedback.elevation.velocity_dps, supply_v


def _weather(state: ControllerState) -> tuple[float, float, float]:
    """Return gust, mean wind and light of this tick, to what a station resolves; NaN what is not good."""
    if state.seen is None or state.seen.weather is NOTHING_SENSED:
        return nan, nan, nan
    told = state.seen.weather
    values = (told.wind.good, told.wind_mean_mps, told.light.good)
    gust_mps, mean_mps, irradiance_wm2 = (nan if value is None else round(value, 1) for value in values)
    return gust_mps, mean_mps, irradiance_wm2


def _told(state: ControllerState) -> tuple[float, float]:
    """Return the set-point: of the axes on an azimuth-elevation mount, else of the sky."""
    if state.config.mount.kind is not MountKind.AZIMUTH_ELEVATION:
        told = _setpoint(state)
        return _NO_ORIENTATION if told is None else (told.azimuth_deg, told.elevation_deg)
    azimuth_deg, elevation_deg = state.setpoints.axes.azimuth_deg, state.setpoints.axes.elevation_deg
    return (
        nan if azimuth_deg is None else wrap360(azimuth_deg),
        nan if elevation_deg is None else elevation_deg,
    )


def _stands(state: ControllerState, feedback: Feedback | None) -> tuple[float, float]:
    """Return where the panel stands: axis angles on an azimuth-elevation mount, else its direction."""
    if feedback is None:
        return _NO_ORIENTATION
    if state.config.mount.kind is not MountKind.AZIMUTH_ELEVATION:
        faced = _faced(state, feedback)
        return _NO_ORIENTATION if faced is None else (faced.azimuth_deg, faced.elevation_deg)
    return wrap360(feedback.azimuth.position_deg), feedback.elevation.position_deg


def _corrections(state: ControllerState) -> tuple[float, float]:
    """Return what the light sensors add to the computed axis angles."""
    corrected = _correction(state)
    if corrected is None:
        return 0.0, 0.0
    return corrected.azimuth.degrees, corrected.elevation.degrees


def _faced(state: ControllerState, feedback: Feedback | None) -> Orientation | None:
    if feedback is None:
        return None
    return sky(
        state.config, state.memory.pointing, feedback.azimuth.position_deg, feedback.elevation.position_deg
    )


def _uncorrected(state: ControllerState, feedback: Feedback | None) -> Orientation | None:
    """Return where the panel faces, the pointing error that the light sensors found taken out."""
    corrected = _correction(state)
    if feedback is None or corrected is None:
        return _faced(state, feedback)
    return sky(
        state.config,
        state.memory.pointing,
        feedback.azimuth.position_deg - corrected.azimuth.degrees,
        feedback.elevation.position_deg - corrected.elevation.degrees,
    )


def _correction(state: ControllerState) -> Corrected | None:
    return (
        state.setpoints.correction
        if state.config.hybrid.enabled and isinstance(state.activity, Tracking)
        else None
    )


def _hybrid(state: ControllerState, feedback: Feedback | None) -> HybridState | None:
    corrected = _correction(state)
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


def _setpoint(state: ControllerState) -> Pair | None:
    """Return what the drive was told, in the sky; an axis that was told nothing counts where it is."""
    azimuth_deg, elevation_deg = state.setpoints.axes.azimuth_deg, state.setpoints.axes.elevation_deg
    feedback = state.feedback
    if feedback is None or (azimuth_deg is None and elevation_deg is None):
        return None
    azimuth_deg = feedback.azimuth.position_deg if azimuth_deg is None else azimuth_deg
    elevation_deg = feedback.elevation.position_deg if elevation_deg is None else elevation_deg
    return _pair(sky(state.config, state.memory.pointing, azimuth_deg, elevation_deg))


def _sun_is_up(state: ControllerState) -> bool:
    return state.sun is not None and sun_height_deg(state.config, state.sun) > 0.0


def _off_sun_deg(state: ControllerState, feedback: Feedback | None) -> float | None:
    """Return how far the panel faces from the sun, None while the sun is down."""
    faced, sun = _uncorrected(state, feedback), state.sun
    if faced is None or sun is None or not _sun_is_up(state):
        return None
    height_deg = sun_height_deg(state.config, sun)
    return separation_deg(faced.azimuth_deg, faced.elevation_deg, sun.azimuth_deg, height_deg)


def _following_error_deg(state: ControllerState) -> float | None:
    """Return by how much the axis that follows worst differs from its reference; None while none moves."""
    return max((watched.error_deg for watched in state.watches.values()), key=abs, default=None)


def _in_position(state: ControllerState, feedback: Feedback | None) -> bool:
    if feedback is None:
        return False
    if isinstance(state.activity, Tracking) and isinstance(state.command.azimuth, Position):
        return state.activity.run is None and close_to(
            state.setpoints.axes, feedback, state.config.in_position_deg
        )
    if not at_rest(feedback):
        return False
    if isinstance(state.activity, Tracking):
        return state.activity.run is None and state.activity.phase is not TrackPhase.PAUSED
    if state.setpoints.axes == NOWHERE:
        return False
    return arrived(state.setpoints.axes, feedback, state.config.in_position_deg)


def _axis_state(state: ControllerState, axis: AxisFeedback) -> AxisState:
    """Return an axis as it is shown; a drive goes on saying that it is homed where that was undone."""
    return AxisState(
        moving=axis.moving,
        homed=axis.homed and not is_undone(state),
        at_lower_limit=axis.at_lower_limit,
        at_upper_limit=axis.at_upper_limit,
        at_origin=axis.at_origin,
        position_deg=axis.position_deg,
    )


def _elevation_state(state: ControllerState, fresh: Feedback | None) -> AxisState | None:
    """Return the elevation axis as it is shown, None without a reading or on a mount that lacks it."""
    has_axis = not state.config.mount.single_axis
    return _axis_state(state, fresh.elevation) if fresh and has_axis else None


def _show(showing: Showing) -> ShowProgress:
    plan, seen = showing.course.plan, showing.course.at(showing.elapsed)
    return ShowProgress(
        show_id=plan.show_id,
        phase=showing.phase,
        sun_time=seen.sun_time,
        elapsed_s=showing.elapsed.total_seconds(),
        duration_s=plan.duration.total_seconds(),
        acceleration=plan.acceleration,
        start=plan.begin_at,
        end=plan.end_at,
        sun_is_up=seen.sun_is_up,
    )
