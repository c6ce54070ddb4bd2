"""What the scripts of every page are told, so that nothing the server knows is written in them again."""

from functools import cache

import orjson
from markupsafe import Markup

from app.tracker.state.snapshot import ActivityName, ShowPhase
from app.tracker.values.alarm_words import CALLING, QUIET, AlarmState
from app.web.charts.axis import ANGLE_STEPS_DEG, NUMBER_STEPS, TIME_STEPS_S
from app.web.charts.drawings import HORIZON, SET_DEG
from app.web.languages.catalogue import catalogue_of
from app.web.live.hold_to_run import LATEST_HEARTBEAT
from app.web.live.live_protocol import FLOODED
from app.web.shell.formats import MEASURES, NAMELESS
from app.web.shell.glances import BAR, LOOKS
from app.web.shell.theme import A_YEAR_S
from app.web.shell.themes import CHOICES, GLARE_ABOVE_DEG, NIGHT_BELOW_DEG

BY_HAND = (ActivityName.JOGGING, ActivityName.MOVING)
UNDER_TEST = (
    ActivityName.MOVING,
    ActivityName.MEASURING,
    ActivityName.STOPPING,
    ActivityName.SETTING_HOME,
    ActivityName.HOMING,
)
"""What a tracker does while it is moved by hand, and while a test of its drive or a home run goes on."""
ON_ITS_WAY = (ShowPhase.RUNNING, ShowPhase.PAUSED)


@cache
def page_facts(code: str) -> Markup:
    """Return as JSON what the scripts of a page in a language need to know."""
    language = catalogue_of(code).language
    told = {
        "point": language.point,
        "date": language.date,
        "compass": language.compass,
        "measures": MEASURES,
        "nameless": NAMELESS,
        "steps": {"numbers": NUMBER_STEPS, "angles_deg": ANGLE_STEPS_DEG, "times_s": TIME_STEPS_S},
        "alarms": {"calling": CALLING, "quiet": QUIET, "returned": AlarmState.RETURNED},
        "activities": {"by_hand": BY_HAND, "under_test": UNDER_TEST},
        "show": {"on_its_way": ON_ITS_WAY, "running": ShowPhase.RUNNING},
        "themes": {
            "choices": CHOICES,
            "glare_above_deg": GLARE_ABOVE_DEG,
            "night_below_deg": NIGHT_BELOW_DEG,
        },
        "kept_s": A_YEAR_S,
        "slow_link_ms": round(LATEST_HEARTBEAT.total_seconds() * 1000),
        "flooded": FLOODED,
        "bar": BAR,
        "looks": {name.value: one for name, one in LOOKS.items()},
        "sky": {"radius": HORIZON, "set_deg": SET_DEG},
    }
    return Markup(orjson.dumps(told).decode().replace("<", "\\u003c"))  # noqa: S704 - our own numbers and words
