"""What wind, snow and light demand of this tracker now, in the words of the person who reads it."""

from dataclasses import replace
from datetime import datetime

from app.base.message import N_, Message, Word, say, with_format
from app.tracker.access.continuing import goes_on_soon
from app.tracker.memory.observation import Observation
from app.tracker.protections.guarding import HOLDS, OFF_GUARD, Guarding, latched, limits_of, step
from app.tracker.protections.words import Protection, ProtectionState
from app.tracker.settings.protections import Reaction, StowName
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import EventKind
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Quantity, Sensed

TWILIGHT_DEG = -1.0
"""The sun is followed along the horizon from here on, so that the panel faces it when it rises."""
LATCHED = (Protection.WIND_STOW, Protection.SNOW)
"""What must be seen good before tracking goes on, also after a restart."""
DEMANDS = (Protection.WIND_STOW, Protection.SNOW, Protection.WAIT, Protection.LOW_LIGHT_HOLD)
TITLES = {
    Quantity.WIND: N_("wind sensor"),
    Quantity.SNOW: N_("snow sensor"),
    Quantity.LIGHT: N_("irradiance sensor"),
}
BAD = {
    Quality.MISSING: N_("reports nothing"),
    Quality.STALE: N_("has not reported in time"),
    Quality.FROZEN: N_("reports the same value all the time"),
    Quality.IMPOSSIBLE: N_("reports an implausible value"),
    Quality.BEFORE_RESTART: N_("has reported nothing since the restart"),
}
PROVES_A_SENSOR = (Quality.GOOD, Quality.BEFORE_RESTART)
REACTS = {
    Reaction.IGNORE: N_("the fault is ignored"),
    Reaction.WARN: N_("only a warning is issued"),
    Reaction.HOLD: N_("the panel holds its position"),
    Reaction.STOW: N_("the panel is stowed as a precaution"),
}

_AFTER_SNOW = N_("Tracking continues automatically once the load is off.")
_NEEDS_OPERATOR = N_("Tracking needs the operator. Press Start tracking.")
_STAYS_OFF = N_("Tracking stays off. Press Start tracking once the weather is calm.")


def look(state: ControllerState, seen: Observation) -> None:
    """Take in the weather: run every timer, latch what holds, and say what begins and ends."""
    sensed, before = seen.weather, guarding(state)
    if before is OFF_GUARD and sensed is NOTHING_SENSED and not state.made_up and not _expected(state):
        return
    begun = _sobered(state, before, sensed)
    config, known = state.config.protection, _learnt(state, sensed)
    after = step(begun, config, sensed, known, seen.now, night=_is_night(state, seen))
    state.guarding = after
    latch = after.kind if after.kind in LATCHED else None
    if latch is not state.memory.protection:
        state.remember(protection=latch)
    _say_doubts(state, before, after, sensed)
    if after.kind is not before.kind:
        _say_change(state, before, after)


def guarding(state: ControllerState) -> Guarding:
    """Return the state of the protections; the first time what was latched before the restart."""
    if state.guarding is None:
        state.guarding = latched(state.memory.protection, state.now)
    return state.guarding


def demanded_stow(state: ControllerState) -> StowName | None:
    """Return where the panel belongs: wind wins over a command, a command over snow, snow over park."""
    by_weather, by_command = guarding(state).stow, state.memory.stow
    if by_weather is None:
        return by_command
    parked = by_command in (None, StowName.PARK)
    return by_weather if parked or by_weather is StowName.WIND else by_command


def hold_reason(state: ControllerState) -> Reason | None:
    """Return why tracking stays where it is: too little light, or a sensor that must be seen well."""
    current = guarding(state)
    if current.held is not None:
        return doubt_reason(state, current.held)
    return reason(state) if current.kind in HOLDS else None


def protection_state(state: ControllerState) -> ProtectionState | None:
    """Return what the weather demands now, None where it demands nothing; instants by the site's clock."""
    current = guarding(state)
    if current.held is not None and current.stow is None:
        since = current.doubt(current.held).since or state.now
        why = doubt_reason(state, current.held)
        return ProtectionState(Protection.WAIT, _at_site(state, since), None, why)
    if current.kind not in DEMANDS or current.since is None:
        return None
    end = None
    if current.kind is Protection.WIND_STOW:
        end = current.wind_stow.earliest_end(state.config.protection.wind)
    return ProtectionState(
        current.kind,
        _at_site(state, current.since),
        None if end is None else _at_site(state, end),
        reason(state),
    )


def reason(state: ControllerState) -> Reason:
    """Return the sentence for what holds; it says so where the weather is simulated."""
    found = _reason(state)
    if state.seen is None or not state.seen.weather.simulated:
        return found
    text = found.message
    return replace(found, message=say("{text} The reading is SIMULATED.", text=text))


def _reason(state: ControllerState) -> Reason:
    current, config, name = guarding(state), state.config.protection, state.config.name
    match current.kind:
        case Protection.WIND_STOW:
            return _typhoon_reason(state, current)
        case Protection.SNOW:
            load = say(
                "{load_kg} kg of snow lay on the panel of {name} for {hold_s} s.",
                load_kg=with_format(config.snow.load_kg, "g"),
                name=name,
                hold_s=with_format(config.snow.hold_s, "g"),
            )
            return Reason("snow", load, _afterwards(state, _AFTER_SNOW))
        case Protection.WAIT:
            text = say(
                "{name} holds: the irradiance is below {threshold_wm2} W/m2.",
                name=name,
                threshold_wm2=with_format(config.light.threshold_wm2, "g"),
            )
            return Reason("too_dark", text, _after_dark(state))
        case _:
            text = say(
                "{name} is in low-light hold: for {hold_s} minutes the irradiance was below "
                "{threshold_wm2} W/m2.",
                name=name,
                hold_s=with_format(config.light.hold_s / 60.0, "g"),
                threshold_wm2=with_format(config.light.threshold_wm2, "g"),
            )
            return Reason("hibernation", text, _after_dark(state))


def _afterwards(state: ControllerState, continues: Message) -> Message:
    """Return what this tracker will do once wind or snow demand nothing any more."""
    if state.alarmed is not None:
        return say("The panel is not stowed. {hint}", hint=state.alarmed.hint)
    if state.memory.stow is not None:
        return _stays_stowed(state.memory.stow)
    if goes_on_soon(state):
        return continues
    return _NEEDS_OPERATOR if state.memory.tracking_on else _STAYS_OFF


def _stays_stowed(stow: StowName) -> Message:
    """Return what a tracker will do that was stowed or parked by command."""
    if stow is StowName.PARK:
        return N_("Afterward, the panel returns to its park position.")
    return N_("The panel then stays stowed until you press Resume.")


def _after_dark(state: ControllerState) -> Message:
    """Return what this tracker will do once there is enough light."""
    if state.memory.stow is not None:
        return _stays_stowed(state.memory.stow)
    if goes_on_soon(state):
        return N_("Tracking continues automatically once the irradiance is sufficient.")
    return _NEEDS_OPERATOR if state.memory.tracking_on else N_("No action is needed while tracking is off.")


def doubt_reason(state: ControllerState, quantity: Quantity) -> Reason:
    """Return what is wrong with a sensor, and what that does."""
    quality = state.seen.weather.reading(quantity).quality if state.seen else Quality.MISSING
    bad = BAD.get(quality, N_("was faulty and is monitored until it has been good for long enough"))
    reacts = REACTS[limits_of(state.config.protection, quantity).bad]
    return Reason(
        f"{quantity}_sensor_bad",
        say("The {titles} {bad}; {reacts}.", titles=TITLES[quantity], bad=bad, reacts=reacts),
        N_(
            "Check the sensor, its cable, and its address. The reaction to a faulty sensor is in the "
            "tracker's settings."
        ),
    )


def doubts(state: ControllerState) -> tuple[Reason, ...]:
    """Return the sensors that have been bad for too long and are not ignored."""
    current, config = guarding(state), state.config.protection
    return tuple(
        doubt_reason(state, quantity)
        for quantity in Quantity
        if current.doubt(quantity).ripe and limits_of(config, quantity).bad is not Reaction.IGNORE
    )


def _sobered(state: ControllerState, before: Guarding, sensed: Sensed) -> Guarding:
    """Return the state to go on from: what made-up weather did ends with it, for nothing else would."""
    ended = state.made_up and not sensed.simulated
    state.made_up = sensed.simulated
    return OFF_GUARD if ended else before


def _learnt(state: ControllerState, sensed: Sensed) -> tuple[Quantity, ...]:
    """Return the sensors that can be missed: every real one is remembered, made-up ones are not."""
    known = state.memory.sensors
    if sensed is NOTHING_SENSED:
        return known
    if sensed.simulated:
        return known + tuple(one for one in Quantity if sensed.reading(one).value is not None)
    fresh = tuple(
        one for one in Quantity if one not in known and sensed.reading(one).quality in PROVES_A_SENSOR
    )
    if fresh:
        state.remember(sensors=known + fresh)
    return known + fresh


def _expected(state: ControllerState) -> bool:
    """Return whether there should be a sensor."""
    config = state.config.protection
    required = config.wind.required or config.snow.required or config.light.required
    return required or bool(state.memory.sensors)


def _is_night(state: ControllerState, seen: Observation) -> bool:
    if seen.sun is None:
        return False
    height_deg = seen.sun.apparent_elevation_deg if state.config.refraction else seen.sun.elevation_deg
    return height_deg < TWILIGHT_DEG


def _typhoon_reason(state: ControllerState, current: Guarding) -> Reason:
    name, limits = state.config.name, state.config.protection.wind
    minutes = with_format(limits.resume_after_s / 60.0, "g")
    continues = say("Tracking continues once the wind has been calm for {minutes} min.", minutes=minutes)
    hint = _afterwards(state, continues)
    wind = state.seen.weather.wind if state.seen else None
    if current.wind_doubt.ripe and limits.bad is Reaction.STOW:
        return Reason(
            "wind_sensor_bad",
            doubt_reason(state, Quantity.WIND).message,
            say("Check the sensor. {hint}", hint=hint),
        )
    if wind is not None and wind.quality is Quality.BEFORE_RESTART and wind.value is not None:
        text = say(
            "The wind at {name} was {value} m/s before the restart and is not known to be calm.",
            name=name,
            value=with_format(wind.value, ".1f"),
        )
        return Reason("wind", text, hint)
    if wind is None or wind.good is None:
        return Reason(
            "wind", say("The wind at {name} was too strong and is not known to be calm.", name=name), hint
        )
    if current.wind_stow.unsafe_at == state.now:
        return Reason(
            "wind",
            say(
                "The wind at {name} is too strong: {good} m/s.", name=name, good=with_format(wind.good, ".1f")
            ),
            hint,
        )
    return Reason(
        "wind",
        say(
            "The wind at {name} was too strong; it is {good} m/s now.",
            name=name,
            good=with_format(wind.good, ".1f"),
        ),
        hint,
    )


def _say_change(state: ControllerState, before: Guarding, after: Guarding) -> None:
    if before.kind in DEMANDS:
        text = say(
            "{capitalize} has ended for {name}.",
            capitalize=Word(str(before.kind).capitalize()),
            name=state.config.name,
        )
        state.say(EventKind.PROTECTION_ENDED, text, protection=before.kind)
    if after.kind in DEMANDS:
        why = reason(state)
        state.say(EventKind.PROTECTION_BEGAN, why.message, protection=after.kind, code=why.code)


def _say_doubts(state: ControllerState, before: Guarding, after: Guarding, sensed: Sensed) -> None:
    for quantity in Quantity:
        was, ripe = before.doubt(quantity).ripe, after.doubt(quantity).ripe
        if ripe and not was:
            quality = sensed.reading(quantity).quality
            text = doubt_reason(state, quantity).message
            state.say(EventKind.SENSOR_INVALID, text, quantity=quantity, quality=quality)
        elif was and not ripe:
            text = say("The {titles} reports valid values again.", titles=TITLES[quantity])
            state.say(EventKind.SENSOR_VALID, text, quantity=quantity)


def _at_site(state: ControllerState, steady: datetime) -> datetime:
    return state.site_time + (steady - state.now)
