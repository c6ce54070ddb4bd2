"""An error stands beside a form, never in its place, whatever it is and whoever sends it: see errors.js.

A few pages stand for every kind of what asks; that all pages leave their errors to this one rule is shown by
tests/web/test_error_beside_every_form.py.
"""

from dataclasses import dataclass, replace

import pytest
from playwright.sync_api import Page, Route, expect

from app.tracker.settings.mechanics import Corner, Region
from app.web.http.problems import MEDIA_TYPE, Problem, ProblemCode
from app.web.http.security import TOO_LARGE
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import signed
from tests.fake_alarms import alarm

T1 = "/trackers/T1"
NOISE = ("Failed to load resource", "htmx:error")
FRAGMENT = '<div class="outcome-refused"><b>Not done.</b><p>The controller service does not answer.</p></div>'
PAGE = """<!doctype html><html><head><title>503</title></head><body><main id="content"><section data-problem>
<p class="lead">The controller service does not answer.</p></section></main></body></html>"""
PROXY = "<html><head><title>502</title></head><body><center><h1>502 Bad Gateway</h1></center></body></html>"
JSON = Problem(ProblemCode.STORE_FAILED, TOO_LARGE).body().decode()


@dataclass(frozen=True, slots=True)
class Reply:
    """What comes instead of an answer, and what the page says of it."""

    status: int
    kind: str
    body: str
    said: str


SILENT = "The controller service does not answer."
REPLIES = {
    "outcome": Reply(503, "text/html; charset=utf-8", FRAGMENT, SILENT),
    "refused": Reply(422, "text/html; charset=utf-8", FRAGMENT, SILENT),
    "page": Reply(409, "text/html; charset=utf-8", PAGE, SILENT),
    "problem": Reply(500, MEDIA_TYPE, JSON, TOO_LARGE),
    "too large": Reply(413, "text/html", PROXY, TOO_LARGE),
    "proxy": Reply(502, "text/html", PROXY, "The answer was error 502. Try again in a moment."),
    "nothing": Reply(504, "text/plain", "", "The answer was error 504. Try again in a moment."),
}
EVERY: dict[str, Reply | None] = {**REPLIES, "no answer": None}
NO_ANSWER = "No answer was received"
BY_HTMX = "[hx-get], [hx-post]"
ASK = """async ([at, said]) => {
  const source = document.querySelectorAll('[hx-get], [hx-post]')[at];
  const all = (selector) => [...document.querySelectorAll(selector)];
  const fields = () => all('main :is(input, select, textarea)').map((one) => one.name).join();
  const before = fields();
  const told = () => all('.outcome, [role=status]').some((one) => one.textContent.includes(said));
  const what = source.outerHTML.slice(0, 90);
  const heard = (name) => new Promise((done) => document.addEventListener(name, function hear({ detail }) {
    if (detail.ctx.sourceElement !== source) return;
    document.removeEventListener(name, hear);
    setTimeout(done, 0, true);
  }));
  const [isAsked, ended] = [heard('htmx:before:request'), heard('htmx:finally:request')];
  const isForm = source.matches('form');
  const trigger = isForm ? 'submit' : (source.getAttribute('hx-trigger') ?? 'click').split(/[ ,]/)[0];
  if (trigger === 'load' || trigger === 'every') return '';
  if (isForm) source.noValidate = true;
  const typed = new Event('input', { bubbles: true });
  if (trigger === 'input') document.querySelector('#place input').dispatchEvent(typed);
  else window.htmx.trigger(source, trigger);
  await isAsked;
  await ended;
  if (!source.isConnected) return `${what}: is gone`;
  if (fields() !== before) return `${what}: fields are gone`;
  if (!told()) return `${what}: does not say ${said}`;
  for (const one of all('.outcome')) one.replaceChildren();
  return '';
}"""
"""Has one element ask, and returns what is wrong with the page after the error."""


def answer(page: Page, replies: list[Reply | None]) -> None:
    """Answer what htmx asks for with the first of these errors, or not at all."""

    def fulfil(route: Route) -> None:
        reply = replies[0]
        if "hx-request" not in route.request.headers:
            route.fallback()
        elif reply is None:
            route.abort()
        else:
            route.fulfill(status=reply.status, content_type=reply.kind, body=reply.body)

    page.route("**/*", fulfil)


KINDS = {
    "a form and a part that is asked for while one types": f"{T1}/commissioning/location",
    "keys of a form that ask for another part of it": f"{T1}/machine",
    "photos that are sent, and a signature": f"{T1}/record",
    "orders": f"{T1}/service",
    "lists with a key in each row, and keys that swap nothing": "/alarms",
}


@pytest.mark.parametrize("kind", KINDS)
def test_no_error_takes_the_place_of_anything(kind: str, opened: Opened, plant: Plant) -> None:
    """Everything on the page that asks gets an error, of all in turn."""
    at_now = plant.machine.clock.now()
    plant.machine.alarms = (alarm("drive_lost", at_now), alarm("link_poor", at_now))
    plant.do(plant.machine.emit)
    page = opened(KINDS[kind], allow=NOISE)
    now: list[Reply | None] = [None]
    answer(page, now)
    found, asking = [], page.locator(BY_HTMX).count()
    assert asking > 1
    for at in range(asking):
        now[0] = reply = list(EVERY.values())[at % len(EVERY)]
        found.append(page.evaluate(ASK, [at, reply.said if reply else NO_ANSWER]))
    assert [one for one in found if one] == []


WALL = Region("Wall", (Corner(170.0, 0.0), Corner(190.0, 0.0), Corner(190.0, 30.0)))


def walled(plant: Plant) -> None:
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, machine=replace(tracker.config.machine, regions=(WALL,)))


def test_a_preview_that_fails_keeps_the_regions_and_the_next_good_answer_clears_what_was_told(
    opened: Opened, plant: Plant
) -> None:
    walled(plant)
    page = opened(f"{T1}/machine", allow=NOISE)
    now: list[Reply | None] = [None]
    answer(page, now)
    page.locator("#f-region1_name").fill("Gate")
    for now[0] in (REPLIES["refused"], None):
        page.get_by_role("button", name="Preview regions").click()
        expect(page.locator("#machine-outcome")).to_contain_text(now[0].said if now[0] else NO_ANSWER)
        expect(page.locator("#f-region0_name")).to_have_value("Wall")
        expect(page.locator("#f-region1_name")).to_have_value("Gate")
        page.locator("#machine-outcome").evaluate("one => one.replaceChildren()")
    now[0] = REPLIES["proxy"]
    page.get_by_role("button", name="Preview regions").click()
    told = page.get_by_text("The answer was error 502.")
    expect(told).to_be_visible()
    page.unroute_all()
    page.get_by_role("button", name="Preview regions").click()
    expect(told).to_have_count(0)
    page.evaluate("document.getElementById('regions').remove()")
    page.get_by_role("button", name="Save mechanics").click()
    expect(page.locator("#machine-outcome")).to_contain_text("Reload the page, then try again.")
    assert plant.machine.trackers["T1"].config.machine.regions == (WALL,)


def test_a_signature_stays_beside_an_error(opened: Opened) -> None:
    page = opened(f"{T1}/record", allow=NOISE)
    drawn = signed(page)
    page.locator("#f-technician").fill("Ada")
    now: list[Reply | None] = [None]
    answer(page, now)
    for now[0] in (REPLIES["page"], None):
        page.get_by_role("button", name="Sign record").click()
        expect(page.locator("#sign-form .outcome")).to_contain_text(now[0].said if now[0] else NO_ANSWER)
        expect(page.locator("#f-technician")).to_have_value("Ada")
        expect(page.locator('[name="technician_drawn"]')).to_have_value(drawn)


def test_until_the_script_is_there_htmx_swaps_no_error(opened: Opened, plant: Plant) -> None:
    page = opened("/account", allow=NOISE)
    page.route("**/errors.js*", lambda route: route.abort())
    page.goto(f"{plant.url}{T1}/machine")
    expect(page.locator("#machine-form[data-htmx-powered]")).to_be_attached()
    answer(page, [REPLIES["refused"]])
    with page.expect_response("**/machine/picture"):
        page.get_by_role("button", name="Preview regions").click()
    expect(page.locator("#f-region0_name")).to_be_visible()
