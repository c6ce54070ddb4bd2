"""What each protection goes by, as the pages and the API show it."""

from app.tracker.controller_state import ControllerState
from app.tracker.protections.config import ProtectionConfig
from app.tracker.protections.guarding import limits_of
from app.tracker.snapshot import SensorState
from app.tracker.weather import NOTHING_SENSED, Quality, Quantity, Reading
from app.tracker.weather_protection import BAD, doubt_reason, guarding

UNITS = {Quantity.WIND: "m/s", Quantity.SNOW: "kg", Quantity.LIGHT: "W/m2"}
OFF = {
    Quantity.WIND: "The protection against wind is switched off.",
    Quantity.SNOW: "The protection against snow is switched off.",
    Quantity.LIGHT: "The protection against low light is switched off.",
}
NEVER_TOLD = {
    Quantity.WIND: "There is no protection against wind: no sensor has ever reported.",
    Quantity.SNOW: "There is no protection against snow: no sensor has ever reported.",
    Quantity.LIGHT: "There is no protection against low light: no sensor has ever reported.",
}
PROTECTS = {
    Quantity.WIND: "Protects against wind.",
    Quantity.SNOW: "Protects against snow.",
    Quantity.LIGHT: "Protects against low light.",
}


def sensors(mind: ControllerState) -> tuple[SensorState, ...]:
    """Return one state a protection, in the order of their priority."""
    return tuple(_sensor(mind, quantity) for quantity in Quantity)


def limit_of(config: ProtectionConfig, quantity: Quantity) -> float:
    """Return the value that is judged against: m/s, kg or W/m2."""
    match quantity:
        case Quantity.WIND:
            return config.wind.gust_mps
        case Quantity.SNOW:
            return config.snow.load_kg
        case Quantity.LIGHT:
            return config.light.threshold_wm2


def _sensor(mind: ControllerState, quantity: Quantity) -> SensorState:
    config = mind.config.protection
    limits = limits_of(config, quantity)
    sensed = mind.seen.weather if mind.seen else NOTHING_SENSED
    reading = sensed.reading(quantity)
    made_up = sensed.simulated and reading.value is not None
    known = limits.required or made_up or quantity in mind.memory.sensors
    text = _text(mind, quantity, reading, enabled=limits.enabled, known=known)
    return SensorState(
        quantity=quantity,
        enabled=limits.enabled,
        known=known,
        value=reading.value,
        limit=limit_of(config, quantity),
        unit=UNITS[quantity],
        quality=reading.quality,
        age_s=reading.age_s,
        text=f"{text} The reading is SIMULATED." if made_up else text,
    )


def _text(mind: ControllerState, quantity: Quantity, reading: Reading, *, enabled: bool, known: bool) -> str:
    """Return how far this protection protects, in one sentence."""
    if not enabled:
        return OFF[quantity]
    if not known:
        return NEVER_TOLD[quantity]
    if guarding(mind).doubt(quantity).ripe:
        return doubt_reason(mind, quantity).message
    if reading.quality is not Quality.GOOD:
        return f"The sensor {BAD[reading.quality]}."
    return PROTECTS[quantity]
