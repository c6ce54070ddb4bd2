"""Everything that the search can find: pages, fields and settings, alarms, and sections of the documents."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

from app.alarms.catalogue import ENTRIES
from app.base.message import N_, NOTHING, Message, join, plain, say
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.declared import Declared, declared
from app.web.features.guide import guide
from app.web.features.guide.field_search import SITE_FORMS, TRACKER_FORMS, fields_of
from app.web.features.guide.search_score import Words, words_of
from app.web.features.guide.search_words import ALSO
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import Catalogue
from app.web.languages.known import LANGUAGES
from app.web.shell.frame import SITE_PAGES, TRACKER_PAGES
from app.web.shell.help import help_for
from app.web.shell.setting_forms import field_name

LONGEST_TEXT = 160
SETTING_PAGES = {"protection": "/protections", "machine": "/machine"}
"""Groups of settings that have a page of their own; the others are on the page of the settings."""
WRITTEN_OUT = ("drive", "mount", "hybrid", "strategy")
"""Groups whose pages have fields that are read from their templates."""
ANY_TRACKER = "/trackers/T1"
PAGE, SETTING, ALARM, DOCUMENT = N_("Page"), N_("Setting"), N_("Alarm"), N_("Document")

FURTHER = (
    (N_("Commissioning records"), "/records", N_("Signed records: see, compare, PDF")),
    (N_("Alarm guide"), "/alarms/guide", N_("All alarms, their consequences, and what to do")),
    (N_("Notifications"), "/site/notifications", N_("Where alarms are sent: webhook, e-mail")),
    (N_("Your own page"), "/account", N_("Password, sessions")),
    (N_("Users and sessions"), "/users", N_("Add users, give roles")),
    (N_("Tokens"), "/tokens", N_("Access tokens for programs, cabinet displays, and their PIN")),
    (N_("Audit"), "/audit", N_("Commands and who gave them")),
    (N_("Sign-ins and refusals"), "/audit/access", N_("Sign-ins and refused sign-ins")),
    (N_("Network"), "/network", N_("Where Heliopanel is found: address, port, HTTPS")),
    (N_("Horizon"), "/site/horizon", N_("Skyline around the site")),
    (N_("Certificate"), "/certificate", N_("HTTPS on tablets")),
    (N_("Restore a backup"), "/restore", N_("When the database is damaged: safe mode")),
    (N_("At a glance"), "/studies/glance", N_("Gain from tracking at this site")),
    (N_("Best step program"), "/studies/program", N_("When to step and to which angles")),
    (N_("The five papers"), "/papers", N_("Where the methods come from")),
)
PARTS = (
    (N_("Drive"), "/drive", N_("Connect the drive: profile, address, unit, gear ratio")),
    (
        N_("Drive tests"),
        "/drive-tests",
        N_("Direction, scale, soft limits, stop test, communication-loss test"),
    ),
    (N_("Mount"), "/mount", N_("Axes of the panel, actuators, backtracking")),
    (N_("Strategy"), "/strategy", N_("Continuous, deadband, interval, step program, light sensors")),
    (
        N_("Protections"),
        "/protections",
        N_("Wind, snow, low light, stow positions, warning, maintenance inhibit"),
    ),
    (
        N_("Mechanics"),
        "/machine",
        N_("Overtravel, uncommanded motion, stopping distance, fault reset, forbidden regions"),
    ),
    (N_("Service mode"), "/service", N_("Who may move the tracker now, home reference")),
    (N_("Training"), "/fault-injection", N_("Inject faults on a simulated tracker")),
    (
        N_("Hold to move"),
        "/mast",
        N_("Four jog buttons and two angles, for a phone at the tracker"),
    ),
    (N_("Label"), "/label", N_("Print a label with a QR code")),
    (N_("Location"), "/commissioning/location", N_("Step 1: latitude, longitude, time zone")),
    (N_("Clock"), "/commissioning/clock", N_("Step 2: date, time, NTP")),
    (N_("Shadow test"), "/commissioning/clock/shadow", N_("Shadow of a pole, enter date and time")),
    (N_("Homing"), "/commissioning/homing", N_("Step 3: jog, set home")),
    (N_("Mode"), "/commissioning/mode", N_("Step 4: fixed, azimuth, elevation, dual axis")),
    (N_("Start"), "/commissioning/run", N_("Step 5: start tracking, show movement")),
)


@dataclass(frozen=True, slots=True)
class Entry:
    """Something that can be found, in English, a section of a document in the reader's language.

    `href` of a tracker's is what follows the tracker's own address. `code` is what programs call it.
    """

    kind: Message
    title: Message
    href: str
    text: Message
    code: str = ""
    of_tracker: bool = False
    is_foreign: bool = False


Indexed = tuple[tuple[Entry, Words], ...]


def index() -> Indexed:
    """Return everything that can be found, with its words in English and in the reader's language."""
    return _index(CATALOGUE.get())


@lru_cache(maxsize=len(LANGUAGES))
def _index(_: Catalogue) -> Indexed:
    return (*((entry, _words(entry)) for entry in _entries()), *_documents())


@cache
def _entries() -> tuple[Entry, ...]:
    """Return what is the same in every language: all but the sections of the documents."""
    return (*_pages(), *_settings(), *_fields(), *_alarms())


def _words(entry: Entry) -> Words:
    titles = (entry.title, said(entry.title), *((entry.code,) if "_" in entry.code else ()))
    also = ALSO.get(entry.href) or (ALSO.get(entry.code, "") if entry.code else "")
    return words_of(titles, (also, said(also)), (entry.text, said(entry.text)))


def _pages() -> Iterator[Entry]:
    for label, href in SITE_PAGES:
        yield Entry(PAGE, label, href, _about(href))
    for label, href, text in FURTHER:
        yield Entry(PAGE, label, href, text)
    for label, end, _ in TRACKER_PAGES:
        yield Entry(PAGE, label, end, _about(ANY_TRACKER + end), of_tracker=True)
    for label, end, text in PARTS:
        yield Entry(PAGE, label, end, text, of_tracker=True)


def _settings() -> Iterator[Entry]:
    for path, one in declared(TrackerConfig).items():
        root, _, rest = path.partition(".")
        page, field = (SETTING_PAGES[root], rest) if root in SETTING_PAGES else ("/settings", path)
        if root not in WRITTEN_OUT:
            name = field_name(field)
            yield Entry(SETTING, plain(one.title), f"{page}#f-{name}", _told(one), name, of_tracker=True)


def _told(one: Declared) -> Message:
    if not one.is_number:
        return plain(one.meaning)
    unit = one.setting.unit
    return say("{hint} The unit is {unit}.", hint=one.hint, unit=unit) if unit else one.hint


def _fields() -> Iterator[Entry]:
    for forms, of_tracker in ((SITE_FORMS, False), (TRACKER_FORMS, True)):
        for template, title, path in forms:
            for field in fields_of(template):
                if field.name or template != "settings.html":
                    place = f"{path}#f-{field.name}" if field.name else path
                    yield Entry(
                        SETTING,
                        join(", ", (title, field.label)),
                        place,
                        field.hint,
                        field.name,
                        of_tracker=of_tracker,
                    )


def _alarms() -> Iterator[Entry]:
    for one in ENTRIES:
        place = f"/alarms/guide#alarm-{one.code}"
        yield Entry(ALARM, one.title, place, join(" ", (one.consequence, one.do)), one.code)


def _documents() -> Iterator[tuple[Entry, Words]]:
    for name, section in guide.all_sections():
        is_foreign, title = guide.is_foreign(name), guide.TITLES[name]
        shown = f"{title if is_foreign else said(title)}: {section.title}"
        place = f"/guide/{name}#{section.anchor}"
        entry = Entry(DOCUMENT, plain(shown), place, plain(_start(section)), is_foreign=is_foreign)
        yield entry, words_of((section.title,), (), (section.words,))


def _about(path: str) -> Message:
    helped = help_for(path)
    return helped.purpose if helped else NOTHING


def _start(section: guide.GuideSection) -> str:
    text = section.html.striptags()
    return text if len(text) <= LONGEST_TEXT else text[:LONGEST_TEXT].rsplit(" ", 1)[0] + " …"
