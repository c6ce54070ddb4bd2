"""What each protection goes by, as the pages and the API show it."""

from app.base.message import N_, Message, say
from app.tracker.protections.guarding import limits_of
from app.tracker.settings.protections import ProtectionConfig
from app.tracker.state.controller_state import ControllerState
from app.tracker.state.snapshot import SensorState
from app.tracker.supervision.weather_protection import BAD, doubt_reason, guarding
from app.tracker.weather.weather import NOTHING_SENSED, Quality, Quantity, Reading

UNITS = {Quantity.WIND: "m/s", Quantity.SNOW: "kg", Quantity.LIGHT: "W/m2"}
OFF = {
    Quantity.WIND: N_("The protection against wind is switched off."),
    Quantity.SNOW: N_("The protection against snow is switched off."),
    Quantity.LIGHT: N_("The protection against low light is switched off."),
}
NEVER_TOLD = {
    Quantity.WIND: N_("There is no protection against wind: no sensor has ever reported."),
    Quantity.SNOW: N_("There is no protection against snow: no sensor has ever reported."),
    Quantity.LIGHT: N_("There is no protection against low light: no sensor has ever reported."),
}
PROTECTS = {
    Quantity.WIND: N_("Protects against wind."),
    Quantity.SNOW: N_("Protects against snow."),
    Quantity.LIGHT: N_("Protects against low light."),
}


def sensors(state: ControllerState) -> tuple[SensorState, ...]:
    """Return one state a protection, in the order of their priority."""
    return tuple(_sensor(state, quantity) for quantity in Quantity)


def limit_of(config: ProtectionConfig, quantity: Quantity) -> float:
    """Return the value that is judged against: m/s, kg or W/m2."""
    match quantity:
        case Quantity.WIND:
            return config.wind.gust_mps
        case Quantity.SNOW:
            return config.snow.load_kg
        case Quantity.LIGHT:
            return config.light.threshold_wm2


def _sensor(state: ControllerState, quantity: Quantity) -> SensorState:
    config = state.config.protection
    limits = limits_of(config, quantity)
    sensed = state.seen.weather if state.seen else NOTHING_SENSED
    reading = sensed.reading(quantity)
    made_up = sensed.simulated and reading.value is not None
    known = limits.required or made_up or quantity in state.memory.sensors
    text = _text(state, quantity, reading, enabled=limits.enabled, known=known)
    return SensorState(
        quantity=quantity,
        enabled=limits.enabled,
        known=known,
        value=reading.value,
        limit=limit_of(config, quantity),
        unit=UNITS[quantity],
        quality=reading.quality,
        age_s=reading.age_s,
        text=say("{text} The reading is SIMULATED.", text=text) if made_up else text,
    )


def _text(
    state: ControllerState, quantity: Quantity, reading: Reading, *, enabled: bool, known: bool
) -> Message:
    """Return how far this protection protects, in one sentence."""
    if not enabled:
        return OFF[quantity]
    if not known:
        return NEVER_TOLD[quantity]
    if guarding(state).doubt(quantity).ripe:
        return doubt_reason(state, quantity).message
    if reading.quality is not Quality.GOOD:
        return say("The sensor {bad}.", bad=BAD[reading.quality])
    return PROTECTS[quantity]
