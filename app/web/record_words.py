"""A commissioning record read out in the reader's language; what was signed stays the English text it is."""

import re
from dataclasses import replace
from datetime import datetime

from app.web.languages import CATALOGUE, said
from app.web.languages.known import ENGLISH, in_words
from app.web.record import MISDATED
from app.web.record_files import Paper, Row, Section
from app.web.ui.formats import who

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
    link loss / load / location / longitude / machine / maintenance / maximum / mean / minimum / minutes /
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
    name / by / tracker id / remark / unverified / unverified registers / drive host / drive profile
    / drive serial port / strategy program name"""
NAMED, DOER = frozenset(_listed(_NAMED)), "by"
"""Lines whose value somebody or something was named, and the one of them that tells who did something."""

INSTANT = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d[+-]\d\d:\d\d"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?")
NUMBERED_TEXT = re.compile(r"(-?[\d.]+)( s, read back| degrees)")
LABEL = re.compile(r"(.*?)( mm \(s\)| mm| h| v| \(\D[^()]*\))?( \(\d+\))?", re.DOTALL)
UNITS = {" mm (s)": " (mm/s)", " mm": " (mm)", " h": " (h)", " v": " (V)"}
TITLED = re.compile("Commissioning record: (.*)", re.DOTALL)
MARKED, PICTURED = re.compile(r"No\. (\d+)"), re.compile(r"photo (\d+)")
STATUS = re.compile(rf"(done|to do|to be confirmed)(?:, ({INSTANT}) by (.*?))?\.( .*)?", re.DOTALL)
NEXT_SENTENCE = re.compile(rf" (?=Step \d, )|(?<={re.escape(MISDATED)}) ")
BY = re.compile(rf"(.*) ({INSTANT}) by (.*)", re.DOTALL)
EVENT = re.compile(r"(.*) \(([^()]*)\)", re.DOTALL)


def told(paper: Paper) -> Paper:
    """Return a record to be printed in the language of the request."""
    if CATALOGUE.get().language is ENGLISH:
        return paper
    return replace(
        paper,
        title=told_title(paper.title),
        sections=told_sections(paper.sections),
        mark=_filled(MARKED, NUMBERED, paper.mark) or _own(paper.mark),
        note=_own(IN_ENGLISH) if paper.digest else "",
    )


def heads(paper: Paper) -> tuple[str, ...]:
    """Return what stands below the title: number, hash, and which language was signed."""
    hashed = filled(HASHED, digest=paper.digest) if paper.digest else ""
    return tuple(filter(None, (paper.mark, hashed, paper.note)))


def told_sections(sections: tuple[Section, ...]) -> tuple[Section, ...]:
    """Return the sections of a record in the language of the request."""
    if CATALOGUE.get().language is ENGLISH:
        return sections
    return tuple((told_heading(heading), tuple(map(_told_row, rows))) for heading, rows in sections)


def told_heading(heading: str) -> str:
    """Return the heading of a section in the language of the request."""
    return _own(heading)


def told_title(title: str) -> str:
    """Return the title of a record; the tracker's name in it is left alone."""
    titled = TITLED.fullmatch(title)
    return _own(TITLE).format(name=titled[1]) if titled else said(title)


def told_name(name: str) -> str:
    """Return the name of a line, such as `drive azimuth gear ratio`, in the language of the request."""
    if CATALOGUE.get().language is ENGLISH:
        return name
    if re.fullmatch(INSTANT, name):
        return _instant(name)
    label = LABEL.fullmatch(name)
    base, unit, again = label.groups("") if label else (name, "", "")
    parts = _parts(tuple(base.split()))
    words = " · ".join(map(_own, parts)) if parts else _filled(PICTURED, PHOTO, base) or said(base)
    return f"{words}{UNITS.get(unit, unit)}{again}"


def told_value(name: str, value: str) -> str:
    """Return what stands behind a line's name; what somebody was named is left alone."""
    if CATALOGUE.get().language is ENGLISH or name in NAMED:
        return who(value) if name == DOER else value
    if re.fullmatch(INSTANT, name):
        event = EVENT.fullmatch(value)
        return f"{said(event[1])} ({who(event[2])})" if event else said(value)
    if NUMBER.fullmatch(value):
        return CATALOGUE.get().number(value)
    return _sentence(value) or _words(value)


def filled(text: str, **gaps: object) -> str:
    """Return one of the record's own sentences in the language of the request."""
    return _own(text).format(**gaps)


def _own(text: str) -> str:
    return CATALOGUE.get().pgettext(CONTEXT, text)


def _told_row(row: Row) -> Row:
    name, value = row
    return told_name(name), told_value(name, value)


def _filled(pattern: re.Pattern[str], text: str, told_as: str) -> str:
    """Return a text with a number in it, nothing where what was told is another."""
    found = pattern.fullmatch(told_as)
    return filled(text, number=found[1]) if found else ""


def _parts(words: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names that a line's name is put together from; nothing where one is not known."""
    for count in range(len(words), 0, -1):
        first, rest = " ".join(words[:count]), words[count:]
        if first in PARTS and (not rest or _parts(rest)):
            return (first, *_parts(rest))
    return ()


def _sentence(value: str) -> str:
    """Return what tells when and by whom something was done, or a number with words; else nothing."""
    if re.fullmatch(INSTANT, value):
        return _instant(value)
    if status := STATUS.fullmatch(value):
        word, at, name, rest = status.groups()
        when = filled(VALUES[-1], status=_own(word), at=_instant(at), name=who(name)) if at else _own(word)
        reasons = map(said, NEXT_SENTENCE.split((rest or "").strip()))
        return " ".join(filter(None, (f"{when}{CATALOGUE.get().language.stop}", *reasons)))
    if checked := BY.fullmatch(value):
        return f"{said(checked[1])} {filled(VALUES[-2], at=_instant(checked[2]), name=who(checked[3]))}"
    if measured := NUMBERED_TEXT.fullmatch(value):
        return filled("{number}" + measured[2], number=CATALOGUE.get().number(measured[1]))
    return ""


def _words(value: str) -> str:
    """Return fixed words of a record, words of a setting, or a sentence."""
    if value in VALUES:
        return _own(value)
    spoken, word = said(value), in_words(value)
    if spoken != value or " " in value or said(word) == word:
        return spoken
    return said(word)


def _instant(text: str) -> str:
    """Return an instant with its date as the language writes it, and how far its zone is from UTC."""
    at = datetime.fromisoformat(text)
    return f"{at.strftime(CATALOGUE.get().language.date)} {at:%H:%M:%S} UTC{text[-6:]}"
