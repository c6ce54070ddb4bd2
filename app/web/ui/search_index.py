"""Everything that the search can find: pages, fields and settings, alarms, and sections of the documents."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from app.alarms.catalogue import ENTRIES
from app.web import guide
from app.web.help import help_for
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import Catalogue
from app.web.languages.known import LANGUAGES
from app.web.ui.field_search import SITE_FORMS, TRACKER_FORMS, fields_of
from app.web.ui.frame import SITE_TABS, TRACKER_TABS
from app.web.ui.protection_forms import NUMBERS, TITLES, field_name
from app.web.ui.search_score import Words, words_of
from app.web.ui.search_words import ALSO
from app.web.ui.settings_words import SETTINGS

LONGEST_TEXT = 160
ANY_TRACKER = "/trackers/T1"
PAGE, SETTING, ALARM, DOCUMENT = "Page", "Setting", "Alarm", "Document"

FURTHER = (
    ("Commissioning records", "/records", "Signed records: see, compare, PDF"),
    ("Alarm guide", "/alarms/guide", "All alarms, their consequences, and what to do"),
    ("Notifications", "/site/notifications", "Where alarms are sent: webhook, e-mail"),
    ("Your own page", "/account", "Password, sessions"),
    ("Users and sessions", "/users", "Add users, give roles"),
    ("Tokens", "/tokens", "Access tokens for programs, cabinet displays, and their PIN"),
    ("Audit", "/audit", "Commands and who gave them"),
    ("Sign-ins and refusals", "/audit/access", "Sign-ins and refused sign-ins"),
    ("Network", "/network", "Where Heliopanel is found: address, port, HTTPS"),
    ("Horizon", "/site/horizon", "Skyline around the site"),
    ("Certificate", "/certificate", "HTTPS on tablets"),
    ("Restore a backup", "/restore", "When the database is damaged: safe mode"),
    ("At a glance", "/studies/glance", "Gain from tracking at this site"),
    ("Best step program", "/studies/program", "When to step and to which angles"),
    ("The five papers", "/papers", "Where the methods come from"),
)
PARTS = (
    ("Drive", "/drive", "Connect the drive: profile, address, unit, gear ratio"),
    ("Drive tests", "/drive-tests", "Direction, scale, soft limits, stop test, communication-loss test"),
    ("Mount", "/mount", "Axes of the panel, actuators, backtracking"),
    ("Strategy", "/strategy", "Continuous, deadband, interval, step program, light sensors"),
    ("Protections", "/protections", "Wind, snow, low light, stow positions, warning, maintenance inhibit"),
    (
        "Mechanics",
        "/machine",
        ("Overtravel, uncommanded motion, stopping distance, fault reset, forbidden regions"),
    ),
    ("Service mode", "/service", "Who may move the tracker now, home reference"),
    ("Training", "/fault-injection", "Inject faults on a simulated tracker"),
    ("Label", "/label", "Print a label with a QR code"),
    ("Location", "/commissioning/location", "Step 1: latitude, longitude, time zone"),
    ("Clock", "/commissioning/clock", "Step 2: date, time, NTP"),
    ("Homing", "/commissioning/homing", "Step 3: jog, set home"),
    ("Mode", "/commissioning/mode", "Step 4: fixed, azimuth, elevation, dual axis"),
    ("Run", "/commissioning/run", "Step 5: start tracking, show movement"),
)


@dataclass(frozen=True, slots=True)
class Entry:
    """Something that can be found, in English, a section of a document in the reader's language.

    `href` of a tracker's is what follows the tracker's own address. `code` is what programs call it.
    """

    kind: str
    title: str
    href: str
    text: str
    code: str = ""
    of_tracker: bool = False
    is_foreign: bool = False


Indexed = tuple[tuple[Entry, Words], ...]


def index() -> Indexed:
    """Return everything that can be found, with its words in English and in the reader's language."""
    return _index(CATALOGUE.get())


@lru_cache(maxsize=len(LANGUAGES))
def _index(_: Catalogue) -> Indexed:
    entries = (*_pages(), *_settings(), *_fields(), *_alarms())
    return (*((entry, _words(entry)) for entry in entries), *_documents())


def _words(entry: Entry) -> Words:
    titles = (entry.title, said(entry.title), *((entry.code,) if "_" in entry.code else ()))
    also = ALSO.get(entry.href) or (ALSO.get(entry.code, "") if entry.code else "")
    return words_of(titles, (also, said(also)), (entry.text, said(entry.text)))


def _pages() -> Iterator[Entry]:
    for label, href in SITE_TABS:
        yield Entry(PAGE, label, href, _about(href))
    for label, href, text in FURTHER:
        yield Entry(PAGE, label, href, text)
    for label, end in TRACKER_TABS:
        yield Entry(PAGE, label, end, _about(ANY_TRACKER + end), of_tracker=True)
    for label, end, text in PARTS:
        yield Entry(PAGE, label, end, text, of_tracker=True)


def _settings() -> Iterator[Entry]:
    for field, words in SETTINGS.items():
        text = f"{words.hint} The unit is {words.unit}."
        yield Entry(SETTING, words.label, f"/settings#f-{field}", text, field, of_tracker=True)
    for path, (label, unit, least, most, text) in NUMBERS.items():
        title, field = TITLES.get(path.split(".")[0], ("Warning", ""))[0], field_name(path)
        about = f"{text} {least:g} to {most:g} {unit}."
        place = f"/protections#f-{field}"
        yield Entry(SETTING, f"{title}, {label.lower()}", place, about, field, of_tracker=True)


def _fields() -> Iterator[Entry]:
    for forms, of_tracker in ((SITE_FORMS, False), (TRACKER_FORMS, True)):
        for template, title, path in forms:
            for field in fields_of(template):
                if field.name not in SETTINGS and (field.name or template != "settings.html"):
                    place = f"{path}#f-{field.name}" if field.name else path
                    yield Entry(
                        SETTING,
                        f"{title}, {field.label}",
                        place,
                        field.hint,
                        field.name,
                        of_tracker=of_tracker,
                    )


def _alarms() -> Iterator[Entry]:
    for one in ENTRIES:
        place = f"/alarms/guide#alarm-{one.code}"
        yield Entry(ALARM, one.title, place, f"{one.consequence} {one.do}", one.code)


def _documents() -> Iterator[tuple[Entry, Words]]:
    for name, section in guide.all_sections():
        is_foreign, title = guide.is_foreign(name), guide.TITLES[name]
        shown = f"{title if is_foreign else said(title)}: {section.title}"
        place = f"/guide/{name}#{section.anchor}"
        entry = Entry(DOCUMENT, shown, place, _start(section), is_foreign=is_foreign)
        yield entry, words_of((section.title,), (), (section.words,))


def _about(path: str) -> str:
    helped = help_for(path)
    return helped.purpose if helped else ""


def _start(section: guide.GuideSection) -> str:
    text = section.html.striptags()
    return text if len(text) <= LONGEST_TEXT else text[:LONGEST_TEXT].rsplit(" ", 1)[0] + " …"
