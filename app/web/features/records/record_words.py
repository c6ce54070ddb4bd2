"""The words of a commissioning record: each line is a message whose English text is what is signed."""

from collections.abc import Iterable, Sequence
from datetime import datetime, tzinfo
from enum import Enum

from app.base.message import CONTEXT_END, Message, Word, data, join, made, say_in, with_format
from app.tracker.values.actors import CONTROLLER, FORMERLY

CONTEXT = "record"
NUMBERED, UNSIGNED, TITLE = "No. {number}", "not signed", "Commissioning record: {name}"
HASHED, PAGE, PHOTO = "SHA-256 of the JSON file: {digest}", "page {number}", "photo {number}"
IN_ENGLISH = "The JSON file, which was signed, is in English; this is a translation of it."
SENTENCES = (NUMBERED, UNSIGNED, TITLE, HASHED, PAGE, PHOTO, IN_ENGLISH)

_HEADINGS = """
    Written / Site / Clock / Steps / Homing / Settings as left / Drive / Drive connection test
    / Drive tests / Mounting correction / Now / Events / Remark / Photos / Signatures"""
_PARTS = """
    acceleration / actuator / after / aim / algorithm / altitude / at / automatic homing / axis azimuth /
    axis tilt / azimuth / azimuth offset / bad / bad after / base / baud rate / boot count / bound / by /
    cleaning / clear for / clock / cloud / connection / counts / counts per turn / creep / cross axis tilt /
    deadband / decay / description / direction / drive / elevation / elevation offset / enabled / facing /
    following / following error / frame / gain / gear ratio / ground coverage ratio / gust / hail / hold /
    homing / host / how / hybrid / hysteresis / in position / inverted / jog / jog fast / jog slow / joint /
    kind / latitude / lean east / lean north / least incidence / light / limit switches / limits / link /
    controller / link loss / load / location / longitude / machine / maintenance / maximum / mean /
    minimum / minutes /
    mode / mount / name / night / ntp synchronised / off / off the sun / offset / overrun factor /
    overtravel / panel tilt / parity / park / port / profile / program / protection / rated / reasons /
    recovery / refraction / regions / remark / required / residual / resume after / retracted / rows / run /
    scale / serial / set at / settable clock / simulated / snow / source / speed / steps /
    steps per revolution / stop / stop bits / stows / strategy / supply / supply high / supply low /
    switch way / switches / threshold / time base / times per hour / tracker id / travel / trusted / unit /
    unverified / unverified registers / utc offset / verified / warning / warnings / watchdog /
    watchdog action / wind / wiring / without commands / x / y / z / zero"""
_VALUES = """
    yes / no / none / not set / not selected / not reached yet / not known / not described / not read back
    / not tested since the controller was started / {number} s, read back / {number} degrees / done / to do
    / to be confirmed / unset / manual / system / encoder-deadband / stepped / anything / edge / back
    / {at}, by {name} / {status}, {at}, by {name}"""


def _listed(words: str) -> tuple[str, ...]:
    return tuple(" ".join(one.split()) for one in words.split("/"))


HEADINGS, PARTS, VALUES = _listed(_HEADINGS), frozenset(_listed(_PARTS)), _listed(_VALUES)
TEXTS = (*SENTENCES, *HEADINGS, *sorted(PARTS), *VALUES)
"""Everything that a record says by itself; reasons, results and words of settings have texts of their own."""

_NAMED = """
    name / tracker id / remark / unverified / unverified registers / host / profile / port / program name"""
NAMED, DOER = frozenset(_listed(_NAMED)), "by"
"""Fields that somebody or something was named in, and the one that tells who did something."""
SIGNS = {"mm_s": " (mm/s)", "mm": " (mm)", "h": " (h)", "v": " (V)"}
"""Units that the signed text leaves at the end of a field's name, as a translation writes them."""
UNITS = {
    "deg": "°",
    "dps": "°/s",
    "dps2": "°/s²",
    "m": "m",
    "mps": "m/s",
    "s": "s",
    "kg": "kg",
    "wm2": "W/m²",
}


def own(text: str, **values: object) -> Message:
    """Return one of the record's own texts."""
    return say_in(CONTEXT, text, **values)


def own_template(text: str) -> str:
    """Return what the catalogues have one of the record's own texts under."""
    return f"{CONTEXT}{CONTEXT_END}{text}"


def label(path: Sequence[str]) -> Message:
    """Return the name of a line from the names of the fields that lead to it, the last with its unit."""
    *before, last = path
    name, sign, unit = _measured(last)
    parts = {f"part{number}": own(part) for number, part in enumerate((*_spaced(before), name), start=1)}
    text = " ".join((*_spaced(before), f"{name}{sign}"))
    return made(text, " · ".join(f"{{{part}}}" for part in parts) + unit, parts)


def _spaced(names: Iterable[str]) -> list[str]:
    return [name.replace("_", " ") for name in names]


def _measured(field: str) -> tuple[str, str, str]:
    """Return a field's name in words, its unit as the signed text has it, and as a translation writes it."""
    for unit, sign in SIGNS.items():
        if field.endswith(f"_{unit}"):
            tail = " mm (s)" if unit == "mm_s" else f" {unit}"
            return field.removesuffix(f"_{unit}").replace("_", " "), tail, sign
    words, _, unit = field.rpartition("_")
    if words and unit in UNITS:
        return words.replace("_", " "), f" ({UNITS[unit]})", f" ({UNITS[unit]})"
    return field.replace("_", " "), "", ""


def instant(at: datetime, zone: tzinfo) -> Message:
    """Return an instant with how far its zone is from UTC."""
    local = at.astimezone(zone)
    text = local.isoformat(sep=" ", timespec="seconds")
    values = {"day": with_format(local.date(), "%Y-%m-%d"), "rest": text[10:-6], "off": text[-6:]}
    return made(text, "{day}{rest} UTC{off}", values)


def number(value: float) -> Message:
    """Return a number with at most six decimals."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    digits = len(text.partition(".")[2])
    return made(text, "{number}", {"number": with_format(value, f".{digits}f")})


def person(name: str) -> Message:
    """Return who did something: a name, or what the program calls itself and who has none."""
    if name in (CONTROLLER, FORMERLY):
        return own(name)
    return made(name, "local user", {}) if name in ("local user", "this computer") else data(name)


def value_of(field: str, value: object, zone: tzinfo) -> Message:
    """Return the value of a field: words of a setting are looked up, what was named is left alone."""
    match value:
        case Message():
            return value
        case None:
            return own("none")
        case bool():
            return own("yes" if value else "no")
        case datetime():
            return instant(value, zone)
        case float():
            return number(value)
        case tuple():
            return join("; ", (_entry(field, one, zone) for one in value))
        case str():
            return _told(field, str(value.value if isinstance(value, Enum) else value))
        case _:
            return data(str(value))


def _told(field: str, text: str) -> Message:
    """Return a text: somebody's name, what was named, a word of the record's own, or one of a setting."""
    if field == DOER:
        return person(text)
    if field.replace("_", " ") in NAMED:
        return data(text)
    return own(text) if text in VALUES else made(text, "{word}", {"word": Word(text)})


def _entry(field: str, value: object, zone: tzinfo) -> Message:
    """Return one of several: a reason as its sentence, a part of a setting by its fields, a name as it is."""
    match value:
        case {"message": Message() as message}:
            return message
        case dict():
            told = (_named(name, inner, zone) for name, inner in value.items())
            return join(", ", told)
        case _:
            return value_of(field, value, zone)


def _named(name: str, value: object, zone: tzinfo) -> Message:
    return join(" ", (label((name,)), value_of(name, value, zone)))
