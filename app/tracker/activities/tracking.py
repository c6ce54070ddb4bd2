"""Following the selected mode by the tracker's strategy.

With a deadband the target is judged against the deadband less a margin, so that the panel stays *within* the
deadband: the sun moves 0.0042 degrees a second, and a run takes a second or two.
"""

from math import cos, radians, sin
from typing import assert_never

from app.base.message import N_, join, say
from app.sun.position import Location, SunPosition
from app.tracker.access.interlocks import Action, demand, unmet
from app.tracker.activities.moving import not_arrived
from app.tracker.activities.setpoint_scheduler import due, pursue, widened
from app.tracker.memory.observation import Observation
from app.tracker.motion.hybrid import correct
from app.tracker.mounts.kinematics import FIRST_FOLLOWS
from app.tracker.programs.schedule import Aimed, Followed, Moment, aimed, scheduled, scheduled_dawn
from app.tracker.settings.config import MountConfig, MountKind, NightBehaviour, TrackerConfig
from app.tracker.settings.strategy import (
    DEADBAND,
    SCHEDULES,
    Continuous,
    Deadband,
    EncoderDeadband,
    Interval,
    Stepped,
    Strategy,
)
from app.tracker.state.activity import Stowed, Stowing, Tracking, TrackPhase
from app.tracker.state.announce import announce, announce_if_remote, call_off
from app.tracker.state.axis_demand import paced
from app.tracker.state.controller_state import HALTED, ControllerState, Turn
from app.tracker.state.positioning import arrived, new_run
from app.tracker.state.setpoints import note_correction
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import begin, end_move, fail, interrupt
from app.tracker.state.waiting import end_waiting, wait_untouched
from app.tracker.supervision.weather_protection import TWILIGHT_DEG, demanded_stow, guarding, hold_reason
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason

SUN_DPS = 15.0 / 3600.0

TRACKING = {phase: Tracking(phase) for phase in TrackPhase}
RESTED = {phase: Tracking(phase, rested=True) for phase in TrackPhase}


def track(state: ControllerState) -> None:
    """Follow the selected mode from now on, or raise `CommandRejected`."""
    demand(state, Action.TRACK)
    end_waiting(state)
    if isinstance(state.activity, Tracking):
        return
    end_move(state, N_("tracking was started."))
    if not (isinstance(state.activity, Stowing | Stowed) and guarding(state).stow is state.activity.stow):
        begin(state, TRACKING[TrackPhase.FOLLOWING])
        call_off(state)
        announce_if_remote(state, say("{name} begins to track.", name=state.config.name))
    state.remember(tracking_on=True, stow=None)
    state.say(
        EventKind.TRACKING_STARTED,
        say("Tracking started, mode {mode}.", mode=state.memory.mode),
        mode=state.memory.mode,
    )


def resume(state: ControllerState, after: str = "the restart") -> None:
    """Go on tracking after a restart if it was on and all is trusted, else wait and say for what."""
    if not state.memory.tracking_on:
        return
    reasons = unmet(state, Action.TRACK)
    if not reasons:
        begin(state, TRACKING[TrackPhase.FOLLOWING])
        end_waiting(state)
        if demanded_stow(state) is not None:
            state.say(EventKind.TRACKING_INTERRUPTED, N_("Tracking is on, but the panel stows first."))
            return
        state.say(
            EventKind.TRACKING_RESUMED,
            say("Tracking continues after {after}.", after=after),
            mode=state.memory.mode,
        )
        announce(state, say("{name} continues tracking after {after}.", name=state.config.name, after=after))
        return
    wait_untouched(state, reasons[0])
    why = join(" ", (reason.message for reason in reasons))
    state.say(
        EventKind.TRACKING_INTERRUPTED, say("Tracking is interrupted and needs the operator: {why}", why=why)
    )


def step(state: ControllerState, tracking: Tracking, feedback: Feedback, seen: Observation) -> Turn:
    """Return a run to the target where the panel is about to leave the deadband, else hold."""
    sun, mode = seen.sun, state.memory.mode
    if not seen.clock_trusted:
        return Turn(_paused(state, tracking), HALTED, None, sun)
    if sun is None or mode is None or seen.location is None:
        interrupt(state, _SUN_UNKNOWN)
        return Turn(state.activity, HALTED, None, sun)
    if hold_reason(state) is not None:
        return Turn(TRACKING[TrackPhase.RESTING], HALTED, None, sun)
    followed = Followed(state.config, state.memory.pointing, mode, state.memory.orientation)
    moment = Moment(seen.site_time, sun, seen.location)
    strategy = DEADBAND if mode is Mode.FIXED else state.config.strategy
    night = mode is not Mode.FIXED and sun_height_deg(state.config, sun) < TWILIGHT_DEG
    if night:
        wanted = _night_place(strategy, followed, moment, seen)
    else:
        wanted = _day_place(strategy, followed, moment, feedback.azimuth.position_deg)
    if wanted is not None and state.config.hybrid.enabled:
        wanted = _corrected(state, followed, moment, wanted, feedback)
    run = tracking.run
    if run is not None and not arrived(run.target, feedback, state.config.in_position_deg):
        return _go_on(state, tracking, strategy, feedback, wanted, sun)
    if wanted is None:
        return Turn(TRACKING[TrackPhase.NIGHT], HALTED, None, sun)
    phase = TrackPhase.NIGHT if night else _phase(state.config, mode, wanted)
    return _begin(state, tracking, strategy, phase, feedback, wanted, sun)


def _begin(
    state: ControllerState,
    tracking: Tracking,
    strategy: Strategy,
    phase: TrackPhase,
    feedback: Feedback,
    wanted: Aimed,
    sun: SunPosition,
) -> Turn:
    """Return the motion that the strategy begins now, or stand."""
    if isinstance(strategy, Continuous) and phase is not TrackPhase.NIGHT:
        if _must_wait(state, tracking, phase):
            return Turn(TRACKING[phase], HALTED, wanted.direction, sun)
        return Turn(TRACKING[phase], pursue(paced(state), wanted.target), wanted.direction, sun)
    place = due(strategy, state.config, feedback, wanted.target)
    if place is None:
        stands = RESTED if _has_rested(tracking) else TRACKING
        return Turn(stands[phase], HALTED, wanted.direction, sun)
    if _must_wait(state, tracking, phase):
        return Turn(TRACKING[phase], HALTED, wanted.direction, sun)
    run = new_run(paced(state), feedback, place, state.now)
    return Turn(Tracking(phase, run), run.command, wanted.direction, sun)


def _has_rested(tracking: Tracking) -> bool:
    """Return whether the panel has not moved since the night or a rest."""
    return tracking.rested or tracking.phase in (TrackPhase.NIGHT, TrackPhase.RESTING)


def _must_wait(state: ControllerState, tracking: Tracking, phase: TrackPhase) -> bool:
    """Announce the first motion after the night or a rest; return whether it must wait for that."""
    if phase is TrackPhase.NIGHT or not _has_rested(tracking):
        return False
    announce(state, say("{name} begins to follow the sun.", name=state.config.name))
    return state.countdowns.motion is not None


def _paused(state: ControllerState, tracking: Tracking) -> Tracking:
    """Return tracking that holds while the clock is doubted; it goes on once the clock is trusted again."""
    if tracking.phase is not TrackPhase.PAUSED:
        state.say(
            EventKind.TRACKING_INTERRUPTED, N_("Tracking holds until the site's clock is trusted again.")
        )
    return TRACKING[TrackPhase.PAUSED]


def _day_place(strategy: Strategy, followed: Followed, moment: Moment, near_deg: float) -> Aimed:
    """Return where the panel shall face while the sun is up."""
    match strategy:
        case Deadband() | Continuous() | EncoderDeadband():
            return aimed(followed, followed.direction(moment.sun), near_deg)
        case Interval() | Stepped():
            return scheduled(strategy, followed, moment, near_deg)
    assert_never(strategy)


def _corrected(
    state: ControllerState, followed: Followed, moment: Moment, wanted: Aimed, feedback: Feedback
) -> Aimed:
    """Return the place with the correction that the light sensors ask for added to its axis angles."""
    sun_target = aimed(followed, followed.direction(moment.sun), feedback.azimuth.position_deg).target
    before = state.setpoints.correction
    corrected = correct(before, state.config, followed.mode, sun_target, wanted.target, feedback, state.now)
    note_correction(state, corrected)
    return wanted._replace(target=corrected.target)


def _night_place(strategy: Strategy, followed: Followed, moment: Moment, seen: Observation) -> Aimed | None:
    """Return where the panel waits for the sun; None: wherever it is."""
    near_deg = night_near_deg(followed.config, seen.location, seen.dawn)
    match followed.config.night:
        case NightBehaviour.HOLD:
            return None
        case NightBehaviour.PARK:
            return aimed(followed, followed.config.park, near_deg)
        case NightBehaviour.SUNRISE:
            if seen.dawn is None:
                return None
            if isinstance(strategy, SCHEDULES):
                return scheduled_dawn(strategy, followed, moment, seen.dawn, near_deg)
            return aimed(followed, followed.direction(seen.dawn), near_deg)
    assert_never(followed.config.night)


def sun_height_deg(config: TrackerConfig, sun: SunPosition) -> float:
    """Return the elevation that this tracker goes by: apparent if it refracts."""
    return sun.apparent_elevation_deg if config.refraction else sun.elevation_deg


def _go_on(
    state: ControllerState,
    tracking: Tracking,
    strategy: Strategy,
    feedback: Feedback,
    wanted: Aimed | None,
    sun: SunPosition,
) -> Turn:
    """Go on with the run under way; one that does not arrive in time is a fault."""
    direction = None if wanted is None else wanted.direction
    if tracking.run is None or state.now >= tracking.run.until:
        fail(state, not_arrived(state))
        return Turn(state.activity, HALTED, direction, sun)
    run = tracking.run
    if wanted is not None:
        run = widened(run, strategy, paced(state), feedback, wanted.target, state.now)
    same = run is tracking.run
    return Turn(tracking if same else Tracking(tracking.phase, run), run.command, direction, sun)


def _phase(config: TrackerConfig, mode: Mode, wanted: Aimed) -> TrackPhase:
    if mode is Mode.FIXED:
        return TrackPhase.FIXED
    if wanted.target.limited:
        return TrackPhase.LIMITED
    reach_dps = config.azimuth.speed_dps * abs(cos(radians(wanted.target.elevation_deg)))
    if mode in FIRST_FOLLOWS and reach_dps < SUN_DPS:
        return TrackPhase.KEYHOLE
    return TrackPhase.FOLLOWING


def night_near_deg(config: TrackerConfig, location: Location | None, dawn: SunPosition | None) -> float:
    """Return the end of the first axis's range from which the coming day needs no unwinding."""
    grows = _grows(config.mount, location, dawn)
    return config.azimuth.minimum_deg if grows else config.azimuth.maximum_deg


def _grows(mount: MountConfig, location: Location | None, dawn: SunPosition | None) -> bool:
    """Return whether the first axis's angle grows from dawn to dusk.

    An azimuth does where the sun passes south of the zenith, an hour angle always, and the rotation about a
    level or tilted axis where that points to the south.
    """
    match mount.kind:
        case MountKind.EQUATORIAL:
            return True
        case MountKind.HORIZONTAL_SINGLE_AXIS | MountKind.TILTED_SINGLE_AXIS:
            return cos(radians(mount.axis_azimuth_deg)) <= 0.0
        case MountKind.AZIMUTH_ELEVATION | MountKind.VERTICAL_SINGLE_AXIS:
            return dawn is None or location is None or _passes_south(location, dawn)
    assert_never(mount.kind)


def _passes_south(location: Location, dawn: SunPosition) -> bool:
    """Return whether the latitude lies north of the sun's declination, taken from its rising azimuth."""
    latitude = radians(location.latitude_deg)
    return sin(latitude) > cos(latitude) * cos(radians(dawn.azimuth_deg))


_SUN_UNKNOWN = Reason(
    "sun_unknown", N_("The position of the sun is not known."), N_("Set location and clock in steps 1 and 2.")
)
