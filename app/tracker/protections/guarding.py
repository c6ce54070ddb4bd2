"""All protections of one tracker together: what is seen goes in, what is demanded comes out."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import assert_never

from app.tracker.protections import low_light, sensor_validity, snow, wind_stow
from app.tracker.protections.low_light import AWAKE, LowLight
from app.tracker.protections.priority import classify
from app.tracker.protections.sensor_validity import WELL, Doubt, demands
from app.tracker.protections.snow import CLEAR, Snow
from app.tracker.protections.wind_stow import CALM, Wind, WindStow
from app.tracker.protections.words import Protection
from app.tracker.settings.protections import (
    LightProtection,
    ProtectionConfig,
    Reaction,
    SnowProtection,
    StowName,
    WindProtection,
)
from app.tracker.weather.weather import Quality, Quantity, Sensed

Limits = WindProtection | SnowProtection | LightProtection
STOWS = {Protection.WIND_STOW: StowName.WIND, Protection.SNOW: StowName.SNOW}
"""The protections that demand a motion, and where to."""
HOLDS = (Protection.WAIT, Protection.LOW_LIGHT_HOLD)
"""The protections that demand that the panel stays where it is."""


@dataclass(frozen=True, slots=True)
class Guarding:
    """The state of all protections; `kind` is what holds, `since` when that began, steady time.

    `held` says that a bad sensor demands that nothing moves.
    """

    wind_stow: WindStow = CALM
    snow: Snow = CLEAR
    low_light: LowLight = AWAKE
    wind_doubt: Doubt = WELL
    snow_doubt: Doubt = WELL
    light_doubt: Doubt = WELL
    kind: Protection | None = None
    since: datetime | None = None
    held: Quantity | None = None

    def doubt(self, quantity: Quantity) -> Doubt:
        """Return the doubt about one sensor."""
        match quantity:
            case Quantity.WIND:
                return self.wind_doubt
            case Quantity.SNOW:
                return self.snow_doubt
            case Quantity.LIGHT:
                return self.light_doubt
        assert_never(quantity)

    @property
    def stow(self) -> StowName | None:
        """Return the stow position that is demanded."""
        return None if self.kind is None else STOWS.get(self.kind)


OFF_GUARD = Guarding()


def latched(kind: Protection | None, now: datetime) -> Guarding:
    """Return the state after a restart: what held still holds, and its time begins anew."""
    match kind:
        case Protection.WIND_STOW:
            return Guarding(wind_stow=WindStow(now, now), kind=kind, since=now)
        case Protection.SNOW:
            return Guarding(snow=Snow(now), kind=kind, since=now)
        case _:
            return OFF_GUARD


def limits_of(config: ProtectionConfig, quantity: Quantity) -> Limits:
    """Return what is set for one sensor."""
    match quantity:
        case Quantity.WIND:
            return config.wind
        case Quantity.SNOW:
            return config.snow
        case Quantity.LIGHT:
            return config.light
        case _ as never:
            assert_never(never)


def step(
    state: Guarding,
    config: ProtectionConfig,
    seen: Sensed,
    known: tuple[Quantity, ...],
    now: datetime,
    *,
    night: bool,
) -> Guarding:
    """Return the state after one look at the weather. `known` are the sensors that were ever seen."""
    doubts = {one: _doubted(state, config, seen, known, now, one) for one in Quantity}
    blown = _wind_stow(state, config.wind, seen, doubts[Quantity.WIND], now)
    loaded = _snow(state, config.snow, seen, doubts[Quantity.SNOW], now)
    dark = _hibernation(state, config.light, seen, doubts[Quantity.LIGHT], now)
    kind = classify(state.kind, blown, loaded, dark, night=night)
    since = state.since if kind is state.kind and state.since is not None else now
    held = _held(config, doubts)
    wind, load, light = (doubts[one] for one in (Quantity.WIND, Quantity.SNOW, Quantity.LIGHT))
    return Guarding(blown, loaded, dark, wind, load, light, kind, since, held)


def wind_of(seen: Sensed, limits: WindProtection, *, doubted: bool = False) -> Wind:
    """Return what is known of the wind; one that was high before the restart is until it is heard again."""
    if seen.wind.quality is Quality.BEFORE_RESTART:
        before = Wind(seen.wind.value, seen.wind_mean_mps, doubted)
        return before if wind_stow.is_high(limits, before) else Wind(None, None, doubted)
    gust_mps = seen.wind.good
    return Wind(gust_mps, None if gust_mps is None else seen.wind_mean_mps, doubted)


def _doubted(
    state: Guarding,
    config: ProtectionConfig,
    seen: Sensed,
    known: tuple[Quantity, ...],
    now: datetime,
    quantity: Quantity,
) -> Doubt:
    limits, reading = limits_of(config, quantity), seen.reading(quantity)
    is_known = limits.enabled and (limits.required or quantity in known)
    good = reading.good is not None
    before = state.doubt(quantity)
    if before.since is None and reading.quality is Quality.BEFORE_RESTART:
        before = Doubt(now - timedelta(seconds=seen.unheard_s))
    return sensor_validity.step(before, good=good, known=is_known, after_s=limits.bad_after_s, now=now)


def _wind_stow(
    state: Guarding, limits: WindProtection, seen: Sensed, doubted: Doubt, now: datetime
) -> WindStow:
    if not limits.enabled:
        return CALM
    wind = wind_of(seen, limits, doubted=demands(doubted, limits.bad, Reaction.STOW))
    return wind_stow.step(state.wind_stow, limits, wind, now)


def _snow(state: Guarding, limits: SnowProtection, seen: Sensed, doubted: Doubt, now: datetime) -> Snow:
    if not limits.enabled:
        return CLEAR
    if demands(doubted, limits.bad, Reaction.STOW):
        return Snow(state.snow.since or now, state.snow.clear_at)
    return snow.step(state.snow, limits, seen.snow.good, now)


def _hibernation(
    state: Guarding, limits: LightProtection, seen: Sensed, doubted: Doubt, now: datetime
) -> LowLight:
    """Return the light's state; a sensor that has failed for good counts as one that is not there."""
    if not limits.enabled or demands(doubted, limits.bad, Reaction.IGNORE, Reaction.WARN):
        return AWAKE
    return low_light.step(state.low_light, limits, seen.light.good, now)


def _held(config: ProtectionConfig, doubts: dict[Quantity, Doubt]) -> Quantity | None:
    """Return the first bad sensor that demands that the panel stays where it is."""
    for quantity, one in doubts.items():
        if demands(one, limits_of(config, quantity).bad, Reaction.HOLD):
            return quantity
    return None
