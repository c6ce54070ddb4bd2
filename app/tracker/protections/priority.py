"""Which protection wins: TYPHOON > SNOW > NIGHT > WAIT > HIBERNATE > TRACK, as Xia et al. (2015) imply."""

from app.tracker.protections.hibernation import Hibernation
from app.tracker.protections.snow import Snow
from app.tracker.protections.typhoon import Typhoon
from app.tracker.protections.words import Protection

WAITS_FOR_LIGHT = (None, Protection.NIGHT, Protection.WAIT)


def classify(
    before: Protection | None, typhoon: Typhoon, snow: Snow, hibernation: Hibernation, *, night: bool
) -> Protection:
    """Return what holds now; `before` is what held until now, None at the start.

    Where the day or the operation begins without enough light, the tracker waits for it.
    """
    if typhoon.since is not None:
        return Protection.TYPHOON
    if snow.since is not None:
        return Protection.SNOW
    if night:
        return Protection.NIGHT
    if before in WAITS_FOR_LIGHT and not hibernation.light_ok:
        return Protection.WAIT
    return Protection.HIBERNATE if hibernation.since is not None else Protection.TRACK
