"""axe-core finds nothing on any page, and none is wider than its screen; the keyboard reaches everything.

By default every rule runs by day on a phone, contrast by night on a desk and for all components in the sun;
`make soak` runs every rule in every theme at both sizes, and in the other languages at both sizes by day.
"""

from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.tracker.alarm_words import AlarmState
from app.web.languages.known import LANGUAGES
from app.web.route_permissions import ROUTES
from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.test_pages_fit import PAGES, T1
from tests.fake_alarms import alarm
from tests.soak import SOAK

AXE = (Path(__file__).parent / "axe" / "4.14.1" / "axe.min.js").read_text()
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
EVERY_RULE = {"runOnly": {"type": "tag", "values": TAGS}, "resultTypes": ["violations"]}
CONTRAST = {"runOnly": {"type": "rule", "values": ["color-contrast"]}, "resultTypes": ["violations"]}
RUN = """async options => (await axe.run(document, options)).violations.flatMap(
  rule => rule.nodes.map(node => `${rule.id}: ${node.target} ${node.html.slice(0, 120)}`))"""
MORE = {
    "alarms": "/alarms",
    "alarms-shelved": "/alarms?view=shelved",
    "alarm-guide": "/alarms/guide",
    "notifications": "/site/notifications",
    "records": "/records",
    "label": f"{T1}/label",
    "accuracy": "/accuracy",
    "papers": "/papers",
    "strategy": f"{T1}/strategy",
    "mount": f"{T1}/mount",
    "training": f"{T1}/training",
    "account": "/account",
    "users": "/users",
    "tokens": "/tokens",
    "audit": "/audit",
    "audit-access": "/audit/access",
    "restore": "/restore",
    "certificate": "/certificate",
    "login": "/login",
    "glance": "/studies/glance",
    "machine": f"{T1}/machine",
    "service": f"{T1}/service",
    "sun-path": f"{T1}/sun-path",
    "trends": f"{T1}/trends",
    "horizon": "/site/horizon",
    "network": "/network",
    "problem": "/trackers/T9",
    "guide": "/guide",
    "document": "/guide/strategies",
    "search": "/search?q=deadband",
    "components": "/components",
    "signed-record": "/records/1",
    "compared-records": "/records/compare?pick=1&pick=2",
}
NO_PAGES = (
    ".csv", ".jpg", ".crt", ".zip", "/backup", "/health", "/ready", "/metrics", "/preview", "/list",
    "/{step}", ".webmanifest", "/commissioning", "/strategy/day", "/guide/pictures/{name}",
)  # fmt: skip
ELSEWHERE = {
    "/setup": "answers only while there is no administrator on an open panel",
    "/kiosk": "answers only where a cabinet panel may be signed in",
    "/prove": "is the sign-in form with another heading",
    "/network/trial": "answers only while another address is tried",
    "/trackers/{tracker_id}/shows/{show_id}": "is looked at by test_science_pages and test_shown",
}
FOCUSED = """() => {
  const seen = document.activeElement;
  if (!seen || seen === document.body) return null;
  const box = seen.getBoundingClientRect();
  const around = [getComputedStyle(seen.closest('.key-choice') ?? seen),
                  getComputedStyle(seen), getComputedStyle(seen, '::after')];
  return {text: seen.outerHTML.slice(0, 90),
          shown: box.width > 0 && box.bottom > 0,
          marked: around.some(style => style.outlineStyle !== 'none' || style.boxShadow !== 'none')};
}"""
REACHABLE = """() => {
  const kinds = 'a[href], button, input:not([type=hidden]), select, textarea, summary';
  return [...document.querySelectorAll(kinds)]
    .filter(one => !one.disabled && one.checkVisibility({visibilityProperty: true}) && one.tabIndex >= 0)
    .filter(one => one.type !== 'radio' || one.checked)
    .map(one => one.outerHTML.slice(0, 90));
}"""
PLANT = """() => {
  const wrong = '<input id="unnamed"><p class="faint">too faint</p>';
  document.querySelector('main').insertAdjacentHTML('beforeend', wrong);
  document.querySelector('.faint').style.color = '#ccc';
}"""


@pytest.fixture
def troubled(plant: Plant) -> Plant:
    """A plant with alarms in every state."""
    machine = plant.machine

    def put() -> None:
        now = machine.clock.now()
        states = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED, AlarmState.RETURNED, AlarmState.SHELVED)
        codes = ("not_stowed", "drive_lost", "link_poor", "gateway_down")
        machine.alarms = tuple(
            replace(
                alarm(code, now),
                state=state,
                shelved_until=now + timedelta(hours=1) if state is AlarmState.SHELVED else None,
            )
            for code, state in zip(codes, states, strict=True)
        )
        machine.emit()

    plant.do(put)
    signed = {"signatures": [{"role": "technician", "name": "Ada", "strokes": [[[9, 9], [500, 200]]]}]}
    for _ in range(2):
        httpx.post(f"{plant.url}/api/v1/trackers/T1/records", json=signed, timeout=60).raise_for_status()
    return plant


PUT = """async path => {
  const answer = await fetch(path);
  const sheet = new DOMParser().parseFromString(await answer.text(), 'text/html');
  const root = document.documentElement;
  for (const one of [...root.attributes]) root.removeAttribute(one.name);
  for (const one of sheet.documentElement.attributes) root.setAttribute(one.name, one.value);
  root.innerHTML = sheet.documentElement.innerHTML;
  root.querySelectorAll('details').forEach(one => { one.open = true; });
  root.querySelectorAll('.footer').forEach(one => { one.style.position = 'static'; });
  const loading = [...root.querySelectorAll('link[rel=stylesheet]')].filter(one => !one.sheet);
  await Promise.all(loading.map(one => new Promise(done => { one.onload = one.onerror = done; })));
}"""
"""Puts a page as it is served in the place of the open one: its scripts do not run, axe-core stays.

The footer goes to the end: what lies below it is scrolled up by people, and axe-core does not scroll.
"""


def rules(name: str, theme: str, size: str, language: str) -> dict[str, Any] | None:
    """Return what is run; every component stands on one page in all themes, so that few need the sun."""
    if language != "en":
        return EVERY_RULE if theme == "day" else None
    if SOAK or (theme, size) == ("day", "phone"):
        return EVERY_RULE
    in_the_sun = theme == "sun" and name in ("components", "homing", "live")
    return CONTRAST if size == "desk" and (theme == "night" or in_the_sun) else None


@pytest.mark.timeout(900)
@pytest.mark.parametrize("language", LANGUAGES if SOAK else ["en"])
def test_axe_finds_nothing_on_any_page_in_any_theme(language: str, troubled: Plant, opened: Opened) -> None:
    page = opened("/certificate", allow=("404", "style-src"))
    page.context.add_cookies([{"name": "language", "value": language, "url": troubled.url}])
    page.evaluate(AXE)
    found = []
    for name, path in (PAGES | MORE).items():
        page.evaluate(PUT, path)
        assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
        for size in ("desk", "phone"):
            page.set_viewport_size({"width": SIZES[size][0], "height": SIZES[size][1]})
            if (wider := page.evaluate("document.documentElement.scrollWidth - innerWidth")) > 0:
                found.append(f"{name} {size}: wider than the screen by {wider} px")
            for theme in ("day", "sun", "night"):
                if wanted := rules(name, theme, size, language):
                    page.evaluate("theme => { document.documentElement.dataset.theme = theme; }", theme)
                    found += [f"{name} {size} {theme}: {one}" for one in page.evaluate(RUN, wanted)]
    assert not found, "\n".join(sorted(set(found)))


def test_axe_would_find_what_is_planted(plant: Plant, opened: Opened) -> None:
    page = opened("/")
    page.evaluate(AXE)
    page.evaluate(PLANT)
    found = " ".join(page.evaluate(RUN, EVERY_RULE))
    assert "label: #unnamed" in found
    assert "color-contrast: .faint" in found


def test_every_page_is_looked_at() -> None:
    looked = {path.split("?")[0].rstrip("/") or "/" for path in (PAGES | MORE).values()}
    routes = [key.removeprefix("GET ") for key in ROUTES if key.startswith("GET /") and "/api/" not in key]
    missing = [
        route for route in routes
        if not route.endswith(NO_PAGES) and route not in ELSEWHERE and not _is_among(route, looked)
    ]  # fmt: skip
    assert missing == []


def _is_among(route: str, looked: set[str]) -> bool:
    parts = route.split("/")
    return any(
        len(parts) == len(path.split("/"))
        and all(a == b or a.startswith("{") for a, b in zip(parts, path.split("/"), strict=True))
        for path in looked
    )


@pytest.mark.parametrize("name", ["homing", "record", "overview"])
def test_the_keyboard_reaches_everything_and_shows_where_it_is(
    name: str, plant: Plant, opened: Opened
) -> None:
    page = opened((PAGES | MORE)[name])
    wanted = page.evaluate(REACHABLE)
    page.evaluate("document.activeElement.blur()")
    reached, hidden = set(), []
    for _ in range(2 * len(wanted) + 20):
        page.keyboard.press("Tab")
        focused = page.evaluate(FOCUSED)
        if focused is None:
            continue
        reached.add(focused["text"])
        if not (focused["shown"] and focused["marked"]):
            hidden.append(focused["text"])
    assert [text for text in wanted if text not in reached] == []
    assert hidden == []


def test_nothing_moves_by_itself_for_who_wants_it_still(troubled: Plant, opened: Opened) -> None:
    page = opened("/alarms")
    page.wait_for_selector("[data-calls]")
    assert page.evaluate("document.getAnimations().length") > 0
    page.emulate_media(reduced_motion="reduce")
    assert page.evaluate("document.getAnimations().length") == 0
