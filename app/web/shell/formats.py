"""How values read on a page; `static/js/format.js` says the same in the browser, and is told the measures."""

from collections.abc import Callable
from datetime import datetime, timedelta
from typing import Any

from app.base.instants import duration
from app.base.message import N_, Message, say, with_format
from app.base.zones import zone_of
from app.tracker.values.actors import CONTROLLER, FORMERLY
from app.web.languages import CATALOGUE
from app.web.languages.known import in_words

UNKNOWN = "–"
NAMELESS = N_("local user")
"""Who has no name: a user at the controller's computer."""
CONTEXT = "record"
"""What the controller is called where it did something by itself, as in a record."""
NO_NAMES = ("site", "network", "panel")
"""What an order or an event may be about that nobody gave a name."""
ISO_DATE = "%Y-%m-%d"


def decimals(value: float, digits: int) -> str:
    """Return a number as the language writes it, with a true minus sign, and none before a rounded zero."""
    text = f"{value:.{digits}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace("-", "−").replace(".", CATALOGUE.get().language.point)


def formatted(pattern: str, *values: object) -> str:
    """Return numbers in a pattern such as `%g s`, as the language writes them."""
    return CATALOGUE.get().number(pattern % values)


def angle(value: float, digits: int = 2) -> str:
    """Return an angle such as `102.40°`."""
    return decimals(value, digits) + "°"


def compass(azimuth_deg: float) -> str:
    """Return the nearest of the sixteen points of the compass."""
    return CATALOGUE.get().language.compass[round(azimuth_deg / 22.5) % 16]


def horizon(elevation_deg: float) -> str:
    """Return on which side of the horizon an elevation lies."""
    return CATALOGUE.get().said(N_("below the horizon") if elevation_deg < 0 else N_("above the horizon"))


def signed_seconds(value: float) -> str:
    """Return a difference of clocks such as `−23 s` or `+2 min 10 s`."""
    if abs(value) < 0.5:
        return "0 s"
    return ("+" if value > 0 else "−") + duration(abs(value))


def local(at: datetime, zone: str, pattern: str) -> str:
    """Return an instant in the civil time of a zone."""
    return at.astimezone(zone_of(zone)).strftime(pattern)


def read_local(at: datetime, zone: str, pattern: str) -> str:
    """Return an instant in the civil time of a zone, its date as the language writes it."""
    return local(at, zone, pattern.replace(ISO_DATE, CATALOGUE.get().language.date))


def offset(at: datetime, zone: str) -> str:
    """Return the zone's distance from UTC at an instant, such as `UTC+3` or `UTC−3:30`."""
    delta = at.astimezone(zone_of(zone)).utcoffset() or timedelta()
    total = round(delta.total_seconds() / 60)
    hours, minutes = divmod(abs(total), 60)
    if not total:
        return "UTC"
    return f"UTC{'+' if total > 0 else '−'}{hours}" + (f":{minutes:02d}" if minutes else "")


def words(value: object) -> str:
    """Return a word that travels, such as `going_to_start`, as people write it in their language."""
    return CATALOGUE.get().gettext(in_words(value))


def word(text: str) -> str:
    """Return a word, or a text of ours that was stored, in the language of the page; others stay."""
    catalogue = CATALOGUE.get()
    return catalogue.said(text) if isinstance(text, Message) else catalogue.word(text)


def range_hint(low: float, high: float, usual: float | str | None = None) -> str:
    """Return what may be typed into a field, and what usually is, in the language of the page."""
    return CATALOGUE.get().said(range_said(low, high, usual))


def range_said(low: float, high: float, usual: float | str | None = None) -> Message:
    """Return the same as a message."""
    ends = {"low": with_format(low, ""), "high": with_format(high, "")}
    if usual is None:
        return say("{low} to {high}.", **ends)
    return say("{low} to {high}, usual {usual}.", **ends, usual=with_format(usual, ""))


def who(value: object) -> str:
    """Return a name as it is; this computer and the controller are told in the language of the page."""
    if value in (CONTROLLER, FORMERLY):
        return CATALOGUE.get().pgettext(CONTEXT, CONTROLLER)
    is_nameless = value == NAMELESS or value == "this computer"  # as it was stored once
    return CATALOGUE.get().said(NAMELESS) if is_nameless else str(value)


def thing(value: str) -> str:
    """Return what something is about: a name as it is, the site as a word."""
    return CATALOGUE.get().word(value) if value in NO_NAMES else value


FORMATS: dict[str, Callable[[Any, str], str]] = {
    "text": lambda value, _: CATALOGUE.get().said(value),
    "who": lambda value, _: who(value),
    "words": lambda value, _: words(value),
    "horizon": lambda value, _: horizon(value),
    "compass": lambda value, _: compass(value),
    "duration": lambda value, _: duration(value),
    "signed_seconds": lambda value, _: signed_seconds(value),
    "freshness": lambda value, _: CATALOGUE.get().said(N_("Stale, not used") if value else N_("Current")),
    "factor": lambda value, _: f"{value:,.0f} ×".replace(",", " "),
    "clock": lambda value, zone: local(value, zone, "%H:%M:%S"),
    "minute": lambda value, zone: local(value, zone, "%H:%M"),
    "date": lambda value, zone: read_local(value, zone, ISO_DATE),
    "moment": lambda value, zone: read_local(value, zone, f"{ISO_DATE} %H:%M:%S"),
    "offset": offset,
}


MEASURES: dict[str, tuple[int, str]] = {
    "angle0": (0, "°"),
    "angle1": (1, "°"),
    "angle2": (2, "°"),
    "age": (1, " s"),
    "mps": (1, " m/s"),
    "wm2": (0, " W/m²"),
    "degc": (1, " °C"),
    "percent": (0, " %"),
    "hpa": (0, " hPa"),
    "mm": (1, " mm"),
    "kg": (1, " kg"),
}
"""Numbers with their unit: how many decimals each has."""


def shown(value: Any, form: str, zone: str) -> str:
    """Return a value in one of the named forms; what is not known is a dash."""
    if value is None:
        return UNKNOWN
    if form in MEASURES:
        digits, unit = MEASURES[form]
        return decimals(value, digits) + unit
    return FORMATS[form](value, zone)
