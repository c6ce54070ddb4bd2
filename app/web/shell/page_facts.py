"""What the scripts of every page are told, so that nothing the server knows is written in them again."""

from functools import cache

import orjson
from markupsafe import Markup

from app.alarms.catalogue import ANY_FAULT
from app.alarms.urgency import FIRST_STATES, IN_DANGER, headline
from app.base.message import N_
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase, Snapshot
from app.tracker.values.alarm_words import CALLING, QUIET
from app.tracker.values.operator_message import INFORMATION, OperatorMessage
from app.web.charts.axis import ANGLE_STEPS_DEG, NUMBER_STEPS, TIME_STEPS_S
from app.web.charts.drawings import HORIZON, SET_DEG
from app.web.languages.catalogue import catalogue_of
from app.web.live.hold_to_run import LATEST_HEARTBEAT
from app.web.live.live_protocol import FLOODED
from app.web.shell.formats import MEASURES, NAMELESS
from app.web.shell.glances import BAR, LOOKS, TOLD_ON_TOP
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

FAULT_LINK = ("#faults", N_("Go to reset"))
CLOCK_LINK = ("/commissioning/clock", N_("Clock"))
MESSAGE_LINKS = {
    ANY_FAULT: FAULT_LINK,
    "local": ("/service", N_("Service")),
    "service": ("/service", N_("Service")),
    "area_not_clear": ("/service", N_("Service")),
    "config_rejected": ("/settings#rejected", N_("Settings")),
    "no_soft_limits": ("/commissioning/homing", N_("Homing")),
    "home_lost": ("/commissioning/homing", N_("Homing")),
    "clock_untrusted": CLOCK_LINK,
    "clock_differs": CLOCK_LINK,
    "clock_drifts": CLOCK_LINK,
    "clock_implausible": CLOCK_LINK,
    "clock_jumped": CLOCK_LINK,
    "clock_off": CLOCK_LINK,
}
"""Where a message about a tracker leads, below its own page, and what the button is called."""
IN_PAGE = 2
"""The least urgent priority that a tracker's own page tells in the page, not only in the bar."""


def message_link(message: OperatorMessage, tracker: Snapshot) -> tuple[str, str] | None:
    """Return where a message about a tracker leads, None where there is nothing to do on another page."""
    is_fault = tracker.fault is not None and tracker.fault.code == message.code
    return FAULT_LINK if is_fault else MESSAGE_LINKS.get(message.code)


def told_in_page(tracker: Snapshot | None) -> OperatorMessage | None:
    """Return the message that a tracker's own page tells in the page, None where nothing is so urgent."""
    first = None if tracker is None else headline(tracker)
    return first if first is not None and first.priority <= IN_PAGE else None


def told_in_bar(tracker: Snapshot) -> OperatorMessage | None:
    """Return the message below the state in the bar: the first, or a stop behind one that the state says."""
    first, second = (*tracker.messages[:2], None, None)[:2]
    says_it = first is not None and first.code == tracker.state
    return second if says_it and second is not None and second.code == EventKind.STOPPED else first


@cache
def page_facts(code: str) -> Markup:
    """Return as JSON what the scripts of a page in a language need to know."""
    catalogue = catalogue_of(code)
    language = catalogue.language
    told = {
        "point": language.point,
        "date": language.date,
        "compass": language.compass,
        "measures": MEASURES,
        "nameless": NAMELESS,
        "steps": {"numbers": NUMBER_STEPS, "angles_deg": ANGLE_STEPS_DEG, "times_s": TIME_STEPS_S},
        "alarms": {"calling": CALLING, "quiet": QUIET},
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
        "urgency": {
            "in_danger": IN_DANGER,
            "first": FIRST_STATES,
            "on_top": TOLD_ON_TOP,
            "information": INFORMATION,
        },
        "messages": {code: (end, catalogue.said(label)) for code, (end, label) in MESSAGE_LINKS.items()}
        | {"in_page": IN_PAGE},
        "sky": {"radius": HORIZON, "set_deg": SET_DEG},
    }
    return Markup(orjson.dumps(told).decode().replace("<", "\\u003c"))  # noqa: S704 - our own numbers and words
