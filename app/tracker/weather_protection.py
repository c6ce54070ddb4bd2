"""What wind, snow and light demand of this tracker now, in the words of the person who reads it."""

from dataclasses import replace
from datetime import datetime

from app.tracker.controller_state import ControllerState
from app.tracker.observation import Observation
from app.tracker.protections.guarding import HOLDS, OFF_GUARD, Guarding, latched, limits_of, step
from app.tracker.protections.words import Protection, ProtectionState, Reaction, StowName
from app.tracker.reason import Reason
from app.tracker.snapshot import EventKind
from app.tracker.weather import NOTHING_SENSED, Quality, Quantity, Sensed

TWILIGHT_DEG = -1.0
"""The sun is followed along the horizon from here on, so that the panel faces it when it rises."""
LATCHED = (Protection.WIND_STOW, Protection.SNOW)
"""What must be seen good before tracking goes on, also after a restart."""
DEMANDS = (Protection.WIND_STOW, Protection.SNOW, Protection.WAIT, Protection.LOW_LIGHT_HOLD)
TITLES = {Quantity.WIND: "wind sensor", Quantity.SNOW: "snow sensor", Quantity.LIGHT: "irradiance sensor"}
BAD = {
    Quality.MISSING: "reports nothing",
    Quality.STALE: "has not reported in time",
    Quality.FROZEN: "reports the same value all the time",
    Quality.IMPOSSIBLE: "reports an implausible value",
    Quality.BEFORE_RESTART: "has reported nothing since the restart",
}
PROVES_A_SENSOR = (Quality.GOOD, Quality.BEFORE_RESTART)
REACTS = {
    Reaction.IGNORE: "the fault is ignored",
    Reaction.WARN: "only a warning is issued",
    Reaction.HOLD: "the panel holds its position",
    Reaction.STOW: "the panel is stowed as a precaution",
}


def look(mind: ControllerState, seen: Observation) -> None:
    """Take in the weather: run every timer, latch what holds, and say what begins and ends."""
    sensed, before = seen.weather, guarding(mind)
    if before is OFF_GUARD and sensed is NOTHING_SENSED and not mind.made_up and not _expected(mind):
        return
    begun = _sobered(mind, before, sensed)
    config, known = mind.config.protection, _learnt(mind, sensed)
    after = step(begun, config, sensed, known, seen.now, night=_is_night(mind, seen))
    mind.guarding = after
    latch = after.kind if after.kind in LATCHED else None
    if latch is not mind.memory.protection:
        mind.remember(protection=latch)
    _say_doubts(mind, before, after, sensed)
    if after.kind is not before.kind:
        _say_change(mind, before, after)


def guarding(mind: ControllerState) -> Guarding:
    """Return the state of the protections; the first time what was latched before the restart."""
    if mind.guarding is None:
        mind.guarding = latched(mind.memory.protection, mind.now)
    return mind.guarding


def demanded_stow(mind: ControllerState) -> StowName | None:
    """Return where the panel belongs: wind wins over a command, a command over snow, snow over park."""
    by_weather, by_command = guarding(mind).stow, mind.memory.stow
    if by_weather is None:
        return by_command
    parked = by_command in (None, StowName.PARK)
    return by_weather if parked or by_weather is StowName.WIND else by_command


def hold_reason(mind: ControllerState) -> Reason | None:
    """Return why tracking stays where it is: too little light, or a sensor that must be seen well."""
    state = guarding(mind)
    if state.held is not None:
        return doubt_reason(mind, state.held)
    return reason(mind) if state.kind in HOLDS else None


def protection_state(mind: ControllerState) -> ProtectionState | None:
    """Return what the weather demands now, None where it demands nothing; instants by the site's clock."""
    state = guarding(mind)
    if state.held is not None and state.stow is None:
        since = state.doubt(state.held).since or mind.now
        why = doubt_reason(mind, state.held)
        return ProtectionState(Protection.WAIT, _at_site(mind, since), None, why)
    if state.kind not in DEMANDS or state.since is None:
        return None
    end = None
    if state.kind is Protection.WIND_STOW:
        end = state.wind_stow.earliest_end(mind.config.protection.wind)
    return ProtectionState(
        state.kind, _at_site(mind, state.since), None if end is None else _at_site(mind, end), reason(mind)
    )


def reason(mind: ControllerState) -> Reason:
    """Return the sentence for what holds; it says so where the weather is simulated."""
    found = _reason(mind)
    if mind.seen is None or not mind.seen.weather.simulated:
        return found
    text = found.message
    return replace(found, message=f"{text} The reading is SIMULATED.")


def _reason(mind: ControllerState) -> Reason:
    state, config, name = guarding(mind), mind.config.protection, mind.config.name
    match state.kind:
        case Protection.WIND_STOW:
            return _typhoon_reason(mind, state)
        case Protection.SNOW:
            load = (
                f"{config.snow.load_kg:g} kg of snow lay on the panel of {name} for {config.snow.hold_s:g} s."
            )
            return Reason("snow", load, "Tracking continues automatically once the load is off.")
        case Protection.WAIT:
            text = f"{name} holds: the irradiance is below {config.light.threshold_wm2:g} W/m2."
            return Reason(
                "too_dark", text, ("Tracking continues automatically once the irradiance is sufficient.")
            )
        case _:
            text = (
                f"{name} is in low-light hold: for {config.light.hold_s / 60.0:g} minutes the "
                f"irradiance was below {config.light.threshold_wm2:g} W/m2."
            )
            return Reason(
                "hibernation", text, ("Tracking continues automatically once the irradiance is sufficient.")
            )


def doubt_reason(mind: ControllerState, quantity: Quantity) -> Reason:
    """Return what is wrong with a sensor, and what that does."""
    quality = mind.seen.weather.reading(quantity).quality if mind.seen else Quality.MISSING
    bad = BAD.get(quality, "was faulty and is monitored until it has been good for long enough")
    reacts = REACTS[limits_of(mind.config.protection, quantity).bad]
    return Reason(
        f"{quantity}_sensor_bad",
        f"The {TITLES[quantity]} {bad}; {reacts}.",
        (
            "Check the sensor, its cable, and its address. The reaction to a faulty sensor is in the "
            "tracker's settings."
        ),
    )


def doubts(mind: ControllerState) -> tuple[Reason, ...]:
    """Return the sensors that have been bad for too long and are not ignored."""
    state, config = guarding(mind), mind.config.protection
    return tuple(
        doubt_reason(mind, quantity)
        for quantity in Quantity
        if state.doubt(quantity).ripe and limits_of(config, quantity).bad is not Reaction.IGNORE
    )


def _sobered(mind: ControllerState, before: Guarding, sensed: Sensed) -> Guarding:
    """Return the state to go on from: what made-up weather did ends with it, for nothing else would."""
    ended = mind.made_up and not sensed.simulated
    mind.made_up = sensed.simulated
    return OFF_GUARD if ended else before


def _learnt(mind: ControllerState, sensed: Sensed) -> tuple[Quantity, ...]:
    """Return the sensors that can be missed: every real one is remembered, made-up ones are not."""
    known = mind.memory.sensors
    if sensed is NOTHING_SENSED:
        return known
    if sensed.simulated:
        return known + tuple(one for one in Quantity if sensed.reading(one).value is not None)
    fresh = tuple(
        one for one in Quantity if one not in known and sensed.reading(one).quality in PROVES_A_SENSOR
    )
    if fresh:
        mind.remember(sensors=known + fresh)
    return known + fresh


def _expected(mind: ControllerState) -> bool:
    """Return whether there should be a sensor."""
    config = mind.config.protection
    required = config.wind.required or config.snow.required or config.light.required
    return required or bool(mind.memory.sensors)


def _is_night(mind: ControllerState, seen: Observation) -> bool:
    if seen.sun is None:
        return False
    height_deg = seen.sun.apparent_elevation_deg if mind.config.refraction else seen.sun.elevation_deg
    return height_deg < TWILIGHT_DEG


def _typhoon_reason(mind: ControllerState, state: Guarding) -> Reason:
    name, limits = mind.config.name, mind.config.protection.wind
    minutes = f"{limits.resume_after_s / 60.0:g}"
    hint = f"Once the wind has been calm for {minutes} minutes, tracking continues if it was on."
    wind = mind.seen.weather.wind if mind.seen else None
    if state.wind_doubt.ripe and limits.bad is Reaction.STOW:
        return Reason(
            "wind_sensor_bad", doubt_reason(mind, Quantity.WIND).message, f"Check the sensor. {hint}"
        )
    if wind is not None and wind.quality is Quality.BEFORE_RESTART and wind.value is not None:
        text = f"The wind at {name} was {wind.value:.1f} m/s before the restart and is not known to be calm."
        return Reason("wind", text, hint)
    if wind is None or wind.good is None:
        return Reason("wind", f"The wind at {name} was too strong and is not known to be calm.", hint)
    if state.wind_stow.unsafe_at == mind.now:
        return Reason("wind", f"The wind at {name} is too strong: {wind.good:.1f} m/s.", hint)
    return Reason("wind", f"The wind at {name} was too strong; it is {wind.good:.1f} m/s now.", hint)


def _say_change(mind: ControllerState, before: Guarding, after: Guarding) -> None:
    if before.kind in DEMANDS:
        text = f"{str(before.kind).capitalize()} has ended for {mind.config.name}."
        mind.say(EventKind.PROTECTION_ENDED, text, protection=before.kind)
    if after.kind in DEMANDS:
        why = reason(mind)
        mind.say(EventKind.PROTECTION_BEGAN, why.message, protection=after.kind, code=why.code)


def _say_doubts(mind: ControllerState, before: Guarding, after: Guarding, sensed: Sensed) -> None:
    for quantity in Quantity:
        was, ripe = before.doubt(quantity).ripe, after.doubt(quantity).ripe
        if ripe and not was:
            quality = sensed.reading(quantity).quality
            text = doubt_reason(mind, quantity).message
            mind.say(EventKind.SENSOR_INVALID, text, quantity=quantity, quality=quality)
        elif was and not ripe:
            text = f"The {TITLES[quantity]} reports valid values again."
            mind.say(EventKind.SENSOR_VALID, text, quantity=quantity)


def _at_site(mind: ControllerState, steady: datetime) -> datetime:
    return mind.site_time + (steady - mind.now)
