"""Following the selected mode: run to zero whenever the panel is about to leave the deadband.

The target is judged against the deadband less a margin, so that the panel stays *within* the deadband: the
sun moves 0.0042 degrees a second, and a run takes a second or two.
"""

from math import cos, radians, sin
from typing import assert_never

from app.sun.position import Location, SunPosition
from app.tracker.activities.moving import not_arrived
from app.tracker.activity import AxisPair, Run, Tracking, TrackPhase
from app.tracker.conditions import Action, demand, unmet
from app.tracker.config import NightBehaviour, Orientation, TrackerConfig
from app.tracker.mind import HALTED, Mind, Turn
from app.tracker.mode import Mode
from app.tracker.motion import Feedback
from app.tracker.mount import AxisTarget, aim, mode_direction, needs_move
from app.tracker.observation import Observation
from app.tracker.reason import Reason
from app.tracker.runs import arrived, new_run
from app.tracker.snapshot import EventKind
from app.tracker.transitions import end_move, fail, interrupt

SUN_DPS = 15.0 / 3600.0
TWILIGHT_DEG = -1.0
"""The sun is followed along the horizon from here on, so that the panel faces it when it rises."""
MARGIN_SHARE = 0.2
MARGIN_DEG = 0.1
UNWIND_DEG = 180.0

TRACKING = {phase: Tracking(phase) for phase in TrackPhase}


def track(mind: Mind) -> None:
    """Follow the selected mode from now on, or raise `CommandRejected`."""
    demand(mind, Action.TRACK)
    mind.wait = None
    if isinstance(mind.activity, Tracking):
        return
    end_move(mind, "tracking was started.")
    mind.activity = TRACKING[TrackPhase.FOLLOWING]
    mind.remember(tracking_on=True)
    mind.say(EventKind.TRACKING_STARTED, f"Tracking started, mode {mind.memory.mode}.", mode=mind.memory.mode)


def resume(mind: Mind) -> None:
    """After a restart: go on tracking if it was on and all is trusted, else wait and say for what."""
    if not mind.memory.tracking_on:
        return
    reasons = unmet(mind, Action.TRACK)
    if not reasons:
        mind.activity = TRACKING[TrackPhase.FOLLOWING]
        mind.say(EventKind.TRACKING_RESUMED, "Tracking goes on after the restart.", mode=mind.memory.mode)
        return
    mind.wait = reasons[0]
    why = " ".join(reason.message for reason in reasons)
    mind.say(EventKind.TRACKING_WAITING, f"Tracking waits for the operator: {why}")


def step(mind: Mind, tracking: Tracking, feedback: Feedback, seen: Observation) -> Turn:
    """Return a run to the target where the panel is about to leave the deadband, else hold."""
    sun, mode = seen.sun, mind.memory.mode
    if not seen.clock_trusted:
        return Turn(_paused(mind, tracking), HALTED, None, sun)
    if sun is None or mode is None:
        interrupt(mind, _SUN_UNKNOWN)
        return Turn(mind.activity, HALTED, None, sun)
    config, pointing, held = mind.config, mind.memory.pointing, mind.memory.orientation
    night = mode is not Mode.FIXED and sun_height_deg(config, sun) < TWILIGHT_DEG
    if night:
        direction = _night_direction(config, mode, held, seen.dawn)
    else:
        direction = mode_direction(mode, held, sun, refraction=config.refraction)
    run = tracking.run
    if run is not None and not arrived(run.target, feedback, config.in_position_deg):
        return _go_on(mind, tracking, run, direction, sun)
    if direction is None:
        return Turn(TRACKING[TrackPhase.NIGHT], HALTED, None, sun)
    near_deg = _night_near_deg(config, seen) if night else feedback.azimuth.position_deg
    target = aim(config, pointing, direction, near_deg)
    phase = TrackPhase.NIGHT if night else _phase(config, mode, direction, target)
    if not off_target(config, feedback, target):
        return Turn(TRACKING[phase], HALTED, direction, sun)
    run = new_run(config, feedback, AxisPair(target.azimuth_deg, target.elevation_deg), mind.now)
    return Turn(Tracking(phase, run), run.command, direction, sun)


def _paused(mind: Mind, tracking: Tracking) -> Tracking:
    """Return tracking that holds while the clock is doubted; it goes on once the clock is trusted again."""
    if tracking.phase is not TrackPhase.PAUSED:
        mind.say(EventKind.TRACKING_WAITING, "Tracking holds until the site's clock is trusted again.")
    return TRACKING[TrackPhase.PAUSED]


def _night_direction(
    config: TrackerConfig, mode: Mode, held: Orientation, dawn: SunPosition | None
) -> Orientation | None:
    """Return where the panel waits for the sun, in the sky; None: wherever it is."""
    match config.night:
        case NightBehaviour.HOLD:
            return None
        case NightBehaviour.PARK:
            return config.park
        case NightBehaviour.SUNRISE:
            if dawn is None:
                return None
            return mode_direction(mode, held, dawn, refraction=config.refraction)
    assert_never(config.night)


def sun_height_deg(config: TrackerConfig, sun: SunPosition) -> float:
    """Return the elevation that this tracker goes by: apparent if it refracts."""
    return sun.apparent_elevation_deg if config.refraction else sun.elevation_deg


def trigger_deg(config: TrackerConfig) -> float:
    """Return the error at which a run begins: the deadband less a margin."""
    return config.deadband_deg - min(MARGIN_DEG, MARGIN_SHARE * config.deadband_deg)


def off_target(config: TrackerConfig, feedback: Feedback, target: AxisTarget) -> bool:
    """Return whether the panel is about to leave the deadband, or stands a turn of the cable away."""
    measured = Orientation(feedback.azimuth.position_deg, feedback.elevation.position_deg)
    if abs(measured.azimuth_deg - target.azimuth_deg) > UNWIND_DEG:
        return True
    place = Orientation(target.azimuth_deg, target.elevation_deg)
    return needs_move(config, measured, place, trigger_deg(config))


def _go_on(mind: Mind, tracking: Tracking, run: Run, target: Orientation | None, sun: SunPosition) -> Turn:
    if mind.now >= run.until:
        fail(mind, not_arrived(mind))
        return Turn(mind.activity, HALTED, target, sun)
    return Turn(tracking, run.command, target, sun)


def _phase(config: TrackerConfig, mode: Mode, direction: Orientation, target: AxisTarget) -> TrackPhase:
    if mode is Mode.FIXED:
        return TrackPhase.FIXED
    if target.limited:
        return TrackPhase.LIMITED
    if config.azimuth.speed_dps * cos(radians(direction.elevation_deg)) < SUN_DPS:
        return TrackPhase.KEYHOLE
    return TrackPhase.FOLLOWING


def _night_near_deg(config: TrackerConfig, seen: Observation) -> float:
    """Return the end of the azimuth range from which the coming day can be followed without unwinding.

    Where the sun passes south of the zenith its azimuth grows, so the day begins low; elsewhere it falls.
    """
    if seen.dawn is None or seen.location is None:
        return config.azimuth.minimum_deg
    grows = _passes_south(seen.location, seen.dawn)
    return config.azimuth.minimum_deg if grows else config.azimuth.maximum_deg


def _passes_south(location: Location, dawn: SunPosition) -> bool:
    """Return whether the latitude lies north of the sun's declination, taken from its rising azimuth."""
    latitude = radians(location.latitude_deg)
    return sin(latitude) > cos(latitude) * cos(radians(dawn.azimuth_deg))


_SUN_UNKNOWN = Reason(
    "sun_unknown", "The position of the sun is not known.", "Set location and clock in steps 1 and 2."
)
