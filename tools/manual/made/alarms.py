"""Every alarm, from the catalogue."""

from datetime import timedelta

from app.alarms.catalogue import ENTRIES, Entry
from tools.manual.made.markdown import code, page, table, text

INTRODUCTION = """Priority comes from the consequence without a response and from the time to respond
(ISA-18.2): 1 within a minute or two, 2 within 10 minutes, 3 within hours, 4 within days. *On* is how
long the condition lasts before the alarm is raised, *off* how long it is gone before the alarm has
returned. An alarm is suppressed by design while one of those in the last column is active at the same
place.

The operator's guide has [what to do in more words](../operate/operators-guide.md#alarms)."""
URGENCY = {1: "a minute or two", 2: "10 minutes", 3: "hours", 4: "days"}


def alarms_page() -> str:
    """Return the page."""
    parts = [_part(priority, [one for one in ENTRIES if one.priority == priority]) for priority in URGENCY]
    return page("Alarms", INTRODUCTION, *parts)


def _part(priority: int, entries: list[Entry]) -> str:
    rows = [
        (
            code(one.code),
            text(one.title),
            text(one.consequence),
            text(one.do),
            one.group.value,
            f"{_seconds(one.on_delay)}, {_seconds(one.off_delay)}",
            ", ".join(code(name) for name in one.suppressed_by),
        )
        for one in entries
    ]
    heads = ("code", "alarm", "consequence", "what to do", "group", "on, off", "suppressed by")
    return f"## Priority {priority}: within {URGENCY[priority]}\n\n" + table(heads, rows)


def _seconds(time: timedelta) -> str:
    return f"{time.total_seconds():g} s"
