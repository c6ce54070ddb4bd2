"""Which protection wins: TYPHOON > SNOW > NIGHT > WAIT > HIBERNATE > TRACK, as Xia et al. (2015) imply."""

from app.tracker.protections.low_light import LowLight
from app.tracker.protections.snow import Snow
from app.tracker.protections.wind_stow import WindStow
from app.tracker.protections.words import Protection

WAITS_FOR_LIGHT = (None, Protection.NIGHT, Protection.WAIT)


def classify(
    before: Protection | None, wind_stow: WindStow, snow: Snow, low_light: LowLight, *, night: bool
) -> Protection:
    """Return what holds now; `before` is what held until now, None at the start.

    Where the day or the operation begins without enough light, the tracker waits for it.
    """
    if wind_stow.since is not None:
        return Protection.WIND_STOW
    if snow.since is not None:
        return Protection.SNOW
    if night:
        return Protection.NIGHT
    if before in WAITS_FOR_LIGHT and not low_light.light_ok:
        return Protection.WAIT
    return Protection.LOW_LIGHT_HOLD if low_light.since is not None else Protection.TRACK
