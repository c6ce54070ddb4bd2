"""Every page of the panel, and what it looks like in trouble: what the tests of looks and reach walk through.

The list is held against the panel's own table of routes, without which no route is served: see `unvisited`.
"""

from dataclasses import dataclass
from enum import StrEnum

from tests.web.route_table import ROUTES

T1 = "/trackers/T1"
T3 = "/trackers/T3"
STUDY_ID = "20260621T120000-0a1b2c"
SHOW_ID = "solstice"
SHOW = f"{T1}/show?date=2026-06-21&start=05:07&end=20:19&minutes=3"


class Where(StrEnum):
    """The panel on which a page is looked at, and who looks."""

    CALM = "calm"
    TROUBLED = "troubled"
    UNHEARD = "unheard"
    LOST = "lost"
    DAMAGED = "damaged"
    CLOSED = "closed"
    TRIAL = "trial"
    STRANGER = "stranger"
    ADMINISTRATOR = "administrator"
    VIEWER = "viewer"
    KIOSK = "kiosk"


@dataclass(frozen=True, slots=True)
class Leaf:
    """One page: its address, where it is looked at, and what is done to it first.

    `sends` names a form of the page by its action: it is sent with a wrong value in every field, and what
    comes back is looked at. `unfolds` names a list that is opened.
    """

    path: str
    where: Where = Where.CALM
    sends: str = ""
    unfolds: str = ""


def _calm(paths: dict[str, str]) -> dict[str, Leaf]:
    return {name: Leaf(path) for name, path in paths.items()}


PAGES = _calm(
    {
        "overview": "/",
        "overview-rows": "/?layout=rows",
        "live": T1,
        "location": f"{T1}/commissioning/location",
        "clock": f"{T1}/commissioning/clock",
        "shadow": f"{T1}/commissioning/clock/shadow",
        "homing": f"{T1}/commissioning/homing",
        "mode": f"{T1}/commissioning/mode",
        "orientation": f"{T1}/commissioning/mode/orientation",
        "run": f"{T1}/commissioning/run",
        "sun-check": f"{T1}/sun-check",
        "record": f"{T1}/record",
        "label": f"{T1}/label",
        "settings": f"{T1}/settings",
        "drive": f"{T1}/drive",
        "proofs": f"{T1}/drive-tests",
        "protections": f"{T1}/protections",
        "machine": f"{T1}/machine",
        "mount": f"{T1}/mount",
        "strategy": f"{T1}/strategy",
        "service": f"{T1}/service",
        "training": f"{T1}/fault-injection",
        "sun-path": f"{T1}/sun-path",
        "trends": f"{T1}/trends",
        "show": SHOW,
        "show-run": f"{T1}/shows/{SHOW_ID}",
        "recordings": "/recordings",
        "player": "/recordings/show-1",
        "compare": "/recordings/show-1?with=day-1",
        "simulate": "/simulate",
        "studies": "/studies",
        "study": f"/studies/{STUDY_ID}",
        "glance": "/studies/glance",
        "step-program": "/studies/program?date=2026-06-21",
        "accuracy": "/accuracy?place=globe&from=2026&to=2026&samples=1000",
        "papers": "/papers?show=yes",
        "journal": "/journal",
        "site": "/site",
        "horizon": "/site/horizon",
        "notifications": "/site/notifications",
        "alarms": "/alarms",
        "alarm-guide": "/alarms/guide",
        "records": "/records",
        "signed-record": "/records/1",
        "compared-records": "/records/compare?pick=1&pick=2",
        "guide": "/guide",
        "document": "/guide/strategies",
        "document-mounts": "/guide/mounts",
        "search": "/search?q=deadband",
        "search-nothing": "/search?q=quux",
        "components": "/components",
        "certificate": "/certificate",
        "network": "/network",
        "restore": "/restore",
        "audit": "/audit",
        "audit-access": "/audit/access",
        "mast": f"{T1}/mast",
        "overview-tiles": "/?layout=tiles",
    }
)
STATES = {
    "setup": Leaf("/setup", Where.CLOSED),
    "login": Leaf("/login", Where.STRANGER),
    "login-wrong": Leaf("/login", Where.STRANGER, sends="/login"),
    "kiosk": Leaf("/kiosk", Where.STRANGER),
    "prove": Leaf("/prove", Where.ADMINISTRATOR),
    "account": Leaf("/account", Where.ADMINISTRATOR),
    "users": Leaf("/users", Where.ADMINISTRATOR),
    "users-wrong": Leaf("/users", Where.ADMINISTRATOR, sends="/users"),
    "tokens": Leaf("/tokens", Where.ADMINISTRATOR),
    "kiosk-account": Leaf("/account", Where.KIOSK),
    "kiosk-live": Leaf(T1, Where.KIOSK),
    "viewer-homing": Leaf(f"{T1}/commissioning/homing", Where.VIEWER),
    "viewer-settings": Leaf(f"{T1}/settings", Where.VIEWER),
    "problem-403": Leaf("/users", Where.VIEWER),
    "problem-404": Leaf("/trackers/T9"),
    "problem-409": Leaf(T3, Where.TROUBLED, sends=f"{T3}/park"),
    "problem-422": Leaf("/journal?before=many"),
    "trial": Leaf("/network/trial?ticket=that-of-the-test", Where.TRIAL),
    "trial-over": Leaf("/network/trial"),
    "restore-damaged": Leaf("/restore", Where.DAMAGED),
    "languages": Leaf("/", unfolds=".language"),
    "location-wrong": Leaf(f"{T1}/commissioning/location", sends=f"{T1}/commissioning/location"),
    "orientation-wrong": Leaf(
        f"{T1}/commissioning/mode/orientation", sends=f"{T1}/commissioning/mode/orientation"
    ),
    "settings-wrong": Leaf(f"{T1}/settings", sends=f"{T1}/settings"),
    "protections-wrong": Leaf(f"{T1}/protections", sends=f"{T1}/protections"),
    "horizon-wrong": Leaf("/site/horizon", sends="/site/horizon"),
    "network-wrong": Leaf("/network", sends="/network"),
    "trouble-overview": Leaf("/", Where.TROUBLED),
    "trouble-live": Leaf(T3, Where.TROUBLED),
    "trouble-homing": Leaf(f"{T3}/commissioning/homing", Where.TROUBLED),
    "trouble-settings": Leaf(f"{T3}/settings", Where.TROUBLED),
    "trouble-protections": Leaf(f"{T3}/protections", Where.TROUBLED),
    "trouble-service": Leaf(f"{T3}/service", Where.TROUBLED),
    "trouble-training": Leaf(f"{T3}/fault-injection", Where.TROUBLED),
    "trouble-site": Leaf("/site", Where.TROUBLED),
    "trouble-alarms": Leaf("/alarms", Where.TROUBLED),
    "trouble-shelved": Leaf("/alarms?view=shelved", Where.TROUBLED),
    "problem-503": Leaf(T1, Where.UNHEARD),
    "lost-overview": Leaf("/", Where.LOST),
    "lost-live": Leaf(T1, Where.LOST),
    "lost-homing": Leaf(f"{T1}/commissioning/homing", Where.LOST),
}
EVERY_PAGE = PAGES | STATES
NO_PAGES = {
    "/certificate/ca.crt": "a file",
    "/diagnostics.zip": "a file",
    "/studies/{study_id}/curves.csv": "a file",
    "/studies/{study_id}/table.csv": "a file",
    "/trackers/{tracker_id}/record/photos/{number}.jpg": "a picture",
    "/trackers/{tracker_id}/strategy/program.csv": "a file",
    "/guide/pictures/{name}": "a picture",
    "/manual": "a file",
    "/manifest.webmanifest": "for the browser",
    "/health": "for programs",
    "/ready": "for programs",
    "/metrics": "for programs",
    "/studies/program/program.csv": "a file",
    "/studies/program/table.csv": "a file",
    "/studies/list": "a part of the page of studies",
    "/trackers/{tracker_id}/commissioning": "leads on to the step that is open",
    "/trackers/{tracker_id}/commissioning/location/preview": "a part of the page of the location",
    "/trackers/{tracker_id}/commissioning/run/aim": "a part of the last step",
    "/trackers/{tracker_id}/commissioning/progress/{step}": "a part of the step",
    "/trackers/{tracker_id}/strategy/day": "a part of the page of the strategy",
}
"""Routes beside the pages that answer with something else; a test asks those that are no file."""


def unvisited() -> list[str]:
    """Return every route of the panel that is neither looked at nor known to be no page."""
    looked = [leaf.path.split("?")[0] for leaf in EVERY_PAGE.values()]
    routes = [key.removeprefix("GET ") for key in ROUTES if key.startswith("GET /") and "/api/" not in key]
    return [
        route for route in routes
        if route not in NO_PAGES and not any(_is(route, path, routes) for path in looked)
    ]  # fmt: skip


def _is(route: str, path: str, routes: list[str]) -> bool:
    """Return whether a path is this route's; a route without parameters keeps its path for itself."""
    if path in routes:
        return path == route
    parts, wanted = route.split("/"), path.split("/")
    return len(parts) == len(wanted) and all(
        a == b or a.startswith("{") for a, b in zip(parts, wanted, strict=True)
    )
