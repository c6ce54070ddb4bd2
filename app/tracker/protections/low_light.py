"""HIBERNATE of Xia et al. (2015): in too little light for ten minutes the tracker stays where it is."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.settings.protections import LightProtection


@dataclass(frozen=True, slots=True)
class LowLight:
    """Since when it holds, when it was last not seen dark, and whether the light suffices; steady time.

    `light_ok` is true as long as nothing is known.
    """

    since: datetime | None = None
    light_at: datetime | None = None
    light_ok: bool = True


AWAKE = LowLight()


def step(state: LowLight, limits: LightProtection, irradiance_wm2: float | None, now: datetime) -> LowLight:
    """Return the state after one look at the light, W/m2; None is not known.

    It must be dark for *more* than the delay. Light that exceeds the threshold by the hysteresis ends it at
    once. An unknown light begins the delay anew, and ends nothing.
    """
    if irradiance_wm2 is None:
        return state if state.since is not None else LowLight(None, now, state.light_ok)
    needed_wm2 = limits.threshold_wm2 + (0.0 if state.light_ok else limits.hysteresis_wm2)
    if irradiance_wm2 >= needed_wm2:
        return LowLight(None, now, True)
    light_at = state.light_at or now
    if state.since is not None:
        return LowLight(state.since, light_at, False)
    dark = now - light_at > timedelta(seconds=limits.hold_s)
    return LowLight(now if dark else None, light_at, False)
