"""What a tracker is shown at one tick: instants, the sun and the drive's reading, all as arguments."""

from datetime import datetime, timedelta
from typing import NamedTuple

from app.sun.position import Location, SunPosition
from app.tracker.protections.words import LinkQuality
from app.tracker.values.motion import Feedback
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import NOTHING_SENSED, Sensed

SILENCE = timedelta(seconds=0.6)


class Observation(NamedTuple):
    """Everything from outside that one tick may depend on.

    `now` is the machine's steady time: leases, time-outs and speeds are judged on it. `site_time` is what
    the site's clock shows: it stamps events. `sun` is None while location or clock are unknown; `dawn`
    is the direction of the next sunrise (None: no sunrise ahead). `feedback` is None if this read failed.
    `location_revision` is `SiteState.location_revision`: confirmations carry it. `link` is how the
    drive's replies came of late, None while too few were counted. A drive that was not heard for longer
    than `silence` is lost. `refused` is why the drive was not given its last commands, None if it was.
    """

    now: datetime
    site_time: datetime
    sun: SunPosition | None
    dawn: SunPosition | None
    feedback: Feedback | None
    clock_trusted: bool
    location: Location | None
    location_revision: int = 0
    weather: Sensed = NOTHING_SENSED
    link: LinkQuality | None = None
    silence: timedelta = SILENCE
    refused: Reason | None = None
