"""The location is one view: nothing scrolls, every button is in reach, and a question ends with a change."""

from dataclasses import replace
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.link.messages import SetLocation
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import CONFIRM_MS, arrive, middle
from tests.browser.layout import faults
from tests.browser.page_clock import Stage

PAGE = "/trackers/T1/commissioning/location"
PROGRESS = "/trackers/T1/commissioning/progress/location"
QUESTION = "#place-doubts > .question"
NOISE = ("422", "409")
MOST_WORDS = 60
FURTHER = r"""() => [...document.querySelectorAll(".question-words b + b")]
  .flatMap((one) => one.textContent.match(/\p{L}{2,}/gu) ?? []).length"""
"""The words of what else speaks against a location: all of it is told before it is kept."""
NIGHT_S = 15 * 3600.0
"""So far is the site's clock set on: it is night in Europe, and in the middle of the Atlantic."""
WORDS = r"""() => {
  const words = (text) => text.match(/\p{L}{2,}/gu) ?? [];
  const zone = document.getElementById("f-time_zone").selectedOptions[0];
  const found = [...words(zone.text)];
  for (const root of document.querySelectorAll("#content, .slots, .stop-words")) {
    const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const e = node.parentElement;
      const isShown = e.checkVisibility({ visibilityProperty: true });
      const isRead = isShown && !e.closest("script, option, .visually-hidden");
      if (isRead && getComputedStyle(e).fontSize !== "0px") found.push(...words(node.data));
    }
  }
  return found;
}"""
SCROLLS = """() => {
  const { scrollHeight, scrollWidth } = document.documentElement;
  return [scrollHeight - innerHeight, scrollWidth - innerWidth];
}"""
TOPS = """() => [...document.querySelectorAll(".place .input, .place .key")]
  .map((one) => one.getBoundingClientRect().top)"""
ABOVE_FOLD = """() => {
  const keys = [...document.querySelectorAll(".place .key, .question .key, .slots .key:not(.slot-back)")];
  const hidden = keys.filter((key) => {
    const { top, bottom, x, width, height } = key.getBoundingClientRect();
    const over = document.elementFromPoint(x + width / 2, top + height / 2);
    return top < 0 || bottom > innerHeight || !(key.contains(over) || over?.contains(key));
  });
  return hidden.map((key) => key.textContent.trim());
}"""
STATES = {
    "stored": {},
    "empty": {"latitude": "", "longitude": ""},
    "east and west": {"longitude_side": "W"},
    "north and south": {"latitude_side": "S"},
    "swapped": {"latitude": "36.33", "longitude": "41.2867"},
    "sea": {"latitude": "0", "longitude": "170", "longitude_side": "W"},
    "wrong": {"latitude": "99", "longitude": "36.33x"},
}


def enter(page: Page, typed: dict[str, str]) -> None:
    """Type into the fields, and press a side."""
    for name, text in typed.items():
        if name.endswith("_side"):
            page.locator(f'input[name="{name}"][value="{text}"]').check()
        else:
            page.locator(f"#f-{name}").fill(text)


def ask(page: Page, typed: dict[str, str]) -> None:
    enter(page, typed)
    page.locator("#forward .key").click()
    expect(page.locator(QUESTION)).to_be_visible()


def saved(plant: Plant) -> list[SetLocation]:
    return [one.command for one in plant.machine.orders if isinstance(one.command, SetLocation)]


def in_state(opened: Opened, plant: Plant, state: str, size: str, **how: Any) -> Page:
    plant.machine.rest()
    page = opened(PAGE, size, allow=NOISE, **how)
    if state in ("stored", "empty"):
        enter(page, STATES[state])
    else:
        ask(page, STATES[state])
    return page


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("state", STATES)
def test_a_tablet_shows_all_at_a_glance(opened: Opened, plant: Plant, state: str, language: str) -> None:
    page = in_state(opened, plant, state, "tablet", language=language)
    assert page.evaluate(SCROLLS) == [0, 0]
    assert page.evaluate(ABOVE_FOLD) == []
    assert faults(page) == []
    if language == "en":
        assert len(page.evaluate(WORDS)) - page.evaluate(FURTHER) <= MOST_WORDS


@pytest.mark.parametrize("state", ["stored", "east and west", "swapped"])
def test_at_night_it_fits_too_and_the_zones_tell_two_locations_apart(stage: Stage, state: str) -> None:
    machine = stage.plant.machine
    stage.do(machine.rest)
    clock = replace(machine.site.clock, offset_s=machine.site.clock.offset_s + NIGHT_S)
    stage.do(lambda: setattr(machine, "site", replace(machine.site, clock=clock)))
    stage.advance(1000)
    page = stage.open(PAGE, "tablet", allow=NOISE)
    if STATES[state]:
        ask(page, STATES[state])
    assert page.evaluate(SCROLLS) == [0, 0]
    assert page.evaluate(ABOVE_FOLD) == []
    assert faults(page) == []
    assert len(page.evaluate(WORDS)) - page.evaluate(FURTHER) <= MOST_WORDS
    rows = page.locator("#preview .suns tbody tr").all_inner_texts()
    assert all("horizon" in row for row in rows)
    if state != "stored":
        assert len(rows) == 2
        assert "Europe/Istanbul" in rows[1]


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("state", ["stored", "east and west", "sea"])
def test_a_phone_has_every_button_above_the_fold(
    opened: Opened, plant: Plant, state: str, language: str
) -> None:
    page = in_state(opened, plant, state, "phone", language=language)
    assert page.evaluate("scrollY") == 0
    assert page.evaluate(ABOVE_FOLD) == []
    assert page.evaluate(SCROLLS)[1] == 0


@pytest.mark.parametrize(
    ("state", "answer"), [("east and west", "E"), ("north and south", "N"), ("swapped", "swapped")]
)
def test_one_press_saves_what_was_meant(opened: Opened, plant: Plant, state: str, answer: str) -> None:
    meant = plant.machine.site.location
    assert meant is not None
    page = in_state(opened, plant, state, "tablet")
    page.locator(f'[name="instead"][value="{answer}"]').click()
    arrive(page, "/commissioning/clock")
    (order,) = saved(plant)
    assert order.location.latitude_deg == pytest.approx(meant.latitude_deg)
    assert order.location.longitude_deg == pytest.approx(meant.longitude_deg)


def test_what_was_entered_is_kept_only_when_the_key_is_held(stage: Stage) -> None:
    stage.plant.machine.rest()
    page = stage.open(PAGE, "tablet", allow=NOISE)
    ask(page, STATES["east and west"])
    keep = page.locator('[name="sun_there"]')
    page.mouse.move(*middle(keep))
    for held_ms, orders in ((CONFIRM_MS // 2, 0), (CONFIRM_MS, 1)):
        page.mouse.down()
        stage.advance(held_ms)
        page.mouse.up()
        stage.advance(500)
        assert len(stage.plant.orders("set_location")) == orders
    arrive(page, "/commissioning/clock")


@pytest.mark.parametrize(
    "change",
    [
        {"latitude": "12"},
        {"longitude": "12"},
        {"altitude": "7"},
        {"longitude_side": "E"},
        {"latitude_side": "S"},
    ],
    ids=str,
)
def test_a_question_goes_away_with_a_change(opened: Opened, plant: Plant, change: dict[str, str]) -> None:
    page = in_state(opened, plant, "east and west", "tablet")
    field = page.locator("#f-longitude")
    amber = field.evaluate("one => getComputedStyle(one).borderTopColor")
    assert amber == "rgb(255, 176, 0)"
    expect(page.locator("#preview .map-doubted")).to_have_count(1)
    enter(page, change)
    expect(page.locator(QUESTION)).to_have_count(0)
    expect(page.locator("#preview .map-doubted")).to_have_count(0)
    assert field.evaluate("one => getComputedStyle(one).borderTopColor") != amber
    assert saved(plant) == []


def test_a_question_without_a_safe_answer_is_canceled(opened: Opened, plant: Plant) -> None:
    page = in_state(opened, plant, "sea", "tablet")
    expect(page.locator('[name="instead"]')).to_have_count(0)
    page.locator("[data-cancel]").click()
    expect(page.locator(QUESTION)).to_have_count(0)
    expect(page.locator("#preview .map-doubted")).to_have_count(0)
    expect(page.locator("#f-longitude")).to_have_value("170")
    assert saved(plant) == []


def test_the_question_outlives_the_renewal_of_the_map(stage: Stage) -> None:
    stage.plant.machine.rest()
    page = stage.open(PAGE, "tablet", allow=NOISE)
    ask(page, STATES["east and west"])
    before = page.locator("#preview .suns").inner_text()
    stage.beat_ms = 1000
    stage.advance(40_000)
    assert page.locator(QUESTION).count() == 1
    assert page.locator("#preview .map-doubted").count() == 1
    assert page.locator("#preview .suns").inner_text() != before, "the sun has moved"


def test_the_larger_map_lies_over_the_content_and_is_renewed(opened: Opened, plant: Plant) -> None:
    page = opened(PAGE, "tablet")
    page.get_by_role("button", name="Show larger map").click()
    larger = page.locator("#larger-map")
    for words in ("41° 17′ 12.1″ N", "Sunrise", "Noon elevation", "Sunset", "Europe/Istanbul"):
        expect(larger).to_contain_text(words)
    assert page.evaluate(SCROLLS) == [0, 0]
    stop = page.locator("#stop-key").bounding_box()
    over = larger.bounding_box()
    assert stop is not None
    assert over is not None
    assert over["x"] + over["width"] <= stop["x"]
    page.evaluate("document.getElementById('f-latitude').value = '12'")
    page.evaluate("document.body.dispatchEvent(new CustomEvent('location-typed'))")
    expect(larger).to_contain_text("12° 00′ 00.0″ N")
    expect(larger).to_be_visible()
    larger.get_by_role("button", name="Close").click()
    expect(larger).to_be_hidden()


def test_a_hint_is_seen_while_its_field_is_used_and_moves_nothing(opened: Opened) -> None:
    page = opened(PAGE, "tablet")
    before = page.evaluate(TOPS)
    for name in ("latitude", "longitude", "altitude", "time_zone"):
        expect(page.locator(f"#{name}-hint")).to_be_hidden()
        page.locator(f"#f-{name}").focus()
        expect(page.locator(f"#{name}-hint")).to_be_visible()
        assert page.evaluate(TOPS) == before


def test_what_is_restored_after_a_reload_is_on_the_map(opened: Opened, plant: Plant) -> None:
    page = opened(PAGE, "tablet")
    enter(page, {"longitude": "12.5"})
    expect(page.locator("#preview")).to_contain_text("12.50° E")
    page.reload()
    note = page.locator(".kept-note")
    expect(note).to_be_in_viewport(ratio=1)
    expect(page.locator("#preview")).to_contain_text("12.50° E")
    assert page.evaluate(SCROLLS) == [0, 0]
    assert faults(page) == []


def test_gps_fills_the_fields_or_says_why_it_does_not(opened: Opened, plant: Plant) -> None:
    page = opened(PAGE, "tablet")
    page.evaluate("""() => { navigator.geolocation.getCurrentPosition = (found) => found({ coords: {
      latitude: -33.92, longitude: 18.42, altitude: 7, accuracy: 4 } }); }""")
    page.locator("#use-gps").click()
    expect(page.locator("#device-place .outcome")).to_contain_text("accurate to 4 m")
    expect(page.locator("#f-latitude")).to_have_value("33.92000")
    expect(page.locator('input[name="latitude_side"][value="S"]')).to_be_checked()
    expect(page.locator("#preview")).to_contain_text("18.42° E")


def test_a_browser_without_gps_says_so_at_the_button(stage: Stage) -> None:
    visitor = stage.visitor("tablet")
    visitor.add_init_script("Object.defineProperty(Navigator.prototype, 'geolocation', { value: undefined })")
    page = stage.visit(visitor, PAGE)
    assert page.locator("#use-gps").is_disabled()
    why = page.locator("#device-place .reasons")
    assert (why.bounding_box() or {}).get("width", 0) <= 1
    page.mouse.click(*middle(page.locator("#use-gps")))
    assert "only with pages over HTTPS" in why.inner_text()
    assert (why.bounding_box() or {}).get("width", 0) > 100
    page.mouse.click(5, 5)
    page.locator("#device-place").focus()
    assert (why.bounding_box() or {}).get("width", 0) > 100, "the keyboard comes to it too"


def test_a_side_that_was_pressed_stays_while_the_steps_are_renewed(stage: Stage) -> None:
    page = stage.open(PAGE, "tablet", allow=NOISE)
    stage.until(page.locator('#preview .preview[data-latitude-side="N"]').count)
    page.locator('input[name="latitude_side"][value="S"]').check(force=True)
    page.evaluate(f"""window.htmx.ajax("GET", "{PROGRESS}?here={PAGE}", {{ swap: "none" }})""")
    stage.until(page.locator('#preview .preview[data-latitude-side="S"]').count)
    assert page.locator('input[name="latitude_side"][value="S"]').is_checked()
