"""One small index over pages, settings, alarms and documents."""

from collections.abc import Collection, Iterator

from starlette.requests import Request

from app.alarms.catalogue import ENTRIES
from app.web import guide
from app.web.guide_contexts import Hit
from app.web.help import help_for
from app.web.languages import said
from app.web.ui.field_search import SITE_FORMS, TRACKER_FORMS, fields_of
from app.web.ui.frame import SITE_TABS, TRACKER_TABS, shown_site
from app.web.ui.protection_forms import NUMBERS, TITLES, field_name
from app.web.ui.settings_words import SETTINGS

MOST_HITS = 60
LONGEST_TEXT = 160
FEW_TRACKERS = 10
"""Of so many trackers all fields are found; of more those of the trackers that the words name."""

FURTHER = (
    ("Commissioning records", "/records", "Signed records: see, compare, PDF"),
    ("What alarms mean", "/alarms/guide", "Every alarm, what follows and what to do"),
    ("Notifications", "/site/notifications", "Where alarms are sent: webhook, e-mail"),
    ("Your own page", "/account", "Password, sessions"),
    ("Users and sessions", "/users", "Add users, give roles"),
    ("Tokens", "/tokens", "Access tokens for programs, cabinet panels and their PIN"),
    ("Audit", "/audit", "Who ordered what"),
    ("Log-ins and refusals", "/audit/access", "Who came in, and who was turned away"),
    ("Network", "/network", "Where this panel is found: address, port, https"),
    ("Horizon", "/site/horizon", "What stands round the site"),
    ("Certificate", "/certificate", "HTTPS on tablets"),
    ("Restore a backup", "/restore", "When the database is damaged: safe mode"),
    ("At a glance", "/studies/glance", "What tracking gains here"),
    ("Best step program", "/studies/program", "When to step and to which angles"),
    ("The five papers", "/papers", "Where the methods come from"),
)
PARTS = (
    ("Drive", "/drive", "Connect the drive: profile, address, unit, gear ratio"),
    ("Prove the drive", "/proofs", "Direction, scale, soft limits, stop test, link-loss test"),
    ("Mount", "/mount", "How the panel hangs on its axes, actuators, backtracking"),
    ("Strategy", "/strategy", "Continuous, deadband, interval, step program, light sensors"),
    ("Protections", "/protections", "Wind, snow, light, stow positions, warning, maintenance lock"),
    ("Machine protections", "/machine", "Over-travel, creep, overrun, recovery, forbidden regions"),
    ("Service mode", "/service", "Who may move the machine now, trust in the zero"),
    ("Training", "/training", "Play faults on a simulated tracker"),
    ("Label", "/label", "Print a label with a QR code"),
    ("Location", "/commissioning/location", "Step 1: latitude, longitude, time zone"),
    ("Clock", "/commissioning/clock", "Step 2: date, time, NTP"),
    ("Homing", "/commissioning/homing", "Step 3: move by hand, set zero"),
    ("Mode", "/commissioning/mode", "Step 4: fixed, azimuth, elevation, dual axis"),
    ("Run", "/commissioning/run", "Step 5: start tracking, show movement"),
)


def found(request: Request, words: str) -> tuple[Hit, ...]:
    """Return everything that has all the words: pages first, then settings, alarms and documents."""
    needles = guide.folded(words).split()
    trackers = _trackers(request)
    hits = (hit for hit in _index(trackers, _meant(trackers, needles)) if _fits(hit, needles))
    return (*hits, *(_of_document(name, section) for name, section in guide.found(words)))[:MOST_HITS]


def _of_document(name: str, section: guide.GuideSection) -> Hit:
    """Return a section as what was found, in the language that the document is shown in."""
    is_foreign, title = guide.is_foreign(name), guide.TITLES[name]
    return Hit(
        "Document",
        f"{title if is_foreign else said(title)}: {section.title}",
        _place(name, section),
        _start(section),
        is_foreign=is_foreign,
    )


def _trackers(request: Request) -> tuple[str, ...]:
    site = shown_site(request)
    return tuple(one.tracker_id for one in site.trackers) if site else ()


def _meant(trackers: tuple[str, ...], needles: list[str]) -> tuple[str, ...]:
    """Return the trackers whose fields are looked through."""
    return tuple(name for name in trackers if guide.folded(name) in needles) or trackers[:FEW_TRACKERS]


def _index(trackers: tuple[str, ...], meant: tuple[str, ...]) -> Iterator[Hit]:
    yield from (Hit("Page", label, href, _about(href)) for label, href in SITE_TABS)
    yield from (Hit("Page", *further) for further in FURTHER)
    for name in trackers:
        root = f"/trackers/{name}"
        yield from (
            Hit("Page", f"{name}: {label}", root + end, _about(root + end)) for label, end in TRACKER_TABS
        )
        yield from (Hit("Page", f"{name}: {label}", root + end, text) for label, end, text in PARTS)
    yield from _fields_of_forms(meant)
    for entry in ENTRIES:
        yield Hit(
            "Alarm", entry.title, f"/alarms/guide#alarm-{entry.code}", f"{entry.consequence} {entry.do}"
        )


def _fields_of_forms(meant: tuple[str, ...]) -> Iterator[Hit]:
    for template, title, path in SITE_FORMS:
        yield from _fields(template, title, path)
    for name in meant:
        yield from _settings(name)
        for template, title, end in TRACKER_FORMS:
            yield from _fields(template, f"{name}: {title}", f"/trackers/{name}{end}", but=SETTINGS)


def _settings(name: str) -> Iterator[Hit]:
    root = f"/trackers/{name}"
    for field, words in SETTINGS.items():
        text = f"{words.hint} The unit is {words.unit}."
        yield Hit("Setting", f"{name}: {words.label}", f"{root}/settings#f-{field}", text)
    for path, (label, unit, least, most, text) in NUMBERS.items():
        title = TITLES.get(path.split(".")[0], ("Warning", ""))[0]
        about = f"{text} {least:g} to {most:g} {unit}."
        place = f"{root}/protections#f-{field_name(path)}"
        yield Hit("Setting", f"{name}: {title}, {label.lower()}", place, about)


def _fields(template: str, title: str, path: str, but: Collection[str] = ()) -> Iterator[Hit]:
    for field in fields_of(template):
        if field.name not in but:
            place = f"{path}#f-{field.name}" if field.name else path
            yield Hit("Setting", f"{title}, {field.label}", place, field.hint)


def _about(path: str) -> str:
    helped = help_for(path)
    return helped.purpose if helped else ""


def _place(name: str, section: guide.GuideSection) -> str:
    return f"/guide/{name}#{section.anchor}"


def _start(section: guide.GuideSection) -> str:
    text = section.html.striptags()
    return text if len(text) <= LONGEST_TEXT else text[:LONGEST_TEXT].rsplit(" ", 1)[0] + " …"


def _fits(hit: Hit, needles: list[str]) -> bool:
    text = guide.folded(f"{hit.title} {hit.text} {said(hit.title)} {said(hit.text)}")
    return all(needle in text for needle in needles)
