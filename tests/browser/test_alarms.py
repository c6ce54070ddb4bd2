"""The alarm strip is live on every page; alarms are acknowledged, shelved and heard."""

from dataclasses import replace
from functools import partial

from playwright.sync_api import expect

from app.tracker.values.alarm_words import AlarmState
from app.tracker.values.operator_message import StateWord
from app.tracker.values.reason import Reason
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, in_words
from tests.browser.conftest import Opened, Plant, now, resize
from tests.fake_alarms import alarm


def raised(plant: Plant, *codes: str) -> None:
    machine = plant.machine

    def put() -> None:
        machine.alarms = tuple(alarm(code, machine.clock.now()) for code in codes)
        machine.emit()

    now(plant, put)


def returned(plant: Plant) -> None:
    machine = plant.machine
    machine.alarms = tuple(replace(one, state=AlarmState.RETURNED) for one in machine.alarms)
    machine.emit()


def test_the_strip_is_live_never_jumps_and_acknowledges(plant: Plant, opened: Opened) -> None:
    page = opened("/trackers/T1", "phone", still=True)
    strip = page.locator("#alarm-strip")
    before = strip.bounding_box()
    says = page.locator("#says")
    expect(says).not_to_have_attribute("data-priority", "1")
    raised(plant, "not_stowed", "drive_lost")
    expect(says).to_have_attribute("data-priority", "1")
    expect(says.locator(".says-first")).to_contain_text("Not stowed")
    expect(page.locator('[data-count="2"] b')).to_have_text("1")
    assert strip.bounding_box() == before
    says.locator("summary").click()
    first = says.locator('.message[data-code="not_stowed"]')
    page.clock.run_for(1_000)
    first.get_by_role("button", name="Acknowledge").click()
    expect(first.get_by_role("button", name="Acknowledge")).to_be_hidden()
    expect(says.locator(".message-title").nth(1)).to_contain_text("Drive does not answer")
    assert [one.alarm_id for one in plant.orders("acknowledge_alarm")] == ["not_stowed@T1"]


def test_the_overview_leads_to_danger_and_does_not_tell_it_once_it_is_gone(
    plant: Plant, opened: Opened
) -> None:
    page = opened("/", "tablet")
    card = page.locator('.glance[data-tracker="T1"]')
    urgent = card.get_by_role("link", name="View alarm")
    expect(card.locator("[data-calm]")).to_be_visible()
    expect(urgent).to_be_hidden()
    raised(plant, "not_stowed")
    expect(urgent).to_be_visible()
    expect(card.locator("[data-calm]")).to_be_hidden()
    expect(card.locator(".glance-trouble > span")).to_have_text("Not stowed")
    plant.do(partial(returned, plant))
    expect(card.locator(".glance-trouble")).not_to_contain_text("Not stowed")
    expect(urgent).to_be_hidden()
    expect(card).to_have_attribute("data-priority", "0")


def test_a_card_whose_alarm_is_not_listed_does_not_look_calm_in_a_storm(plant: Plant, opened: Opened) -> None:
    page = opened("/", "phone")
    card = page.locator('.glance[data-tracker="T2"]')
    expect(card.locator("[data-calm]")).to_be_visible()
    why = Reason("not_stowed", "South field does not stow.", "Stow it by hand.")
    plant.do(lambda: setattr(plant.machine.trackers["T2"], "not_stowed", why))
    expect(card.get_by_role("link", name="View alarm")).to_be_visible()
    expect(card.locator("[data-calm]")).to_be_hidden()
    expect(card.locator(".glance-trouble")).to_contain_text("South field does not stow.")
    expect(card.locator('[data-live="state"]')).to_have_text("Not stowed")
    expect(page.locator('.glance[data-tracker="T1"] [data-calm]')).to_be_visible()


def test_an_alarm_is_shelved_with_a_reason(plant: Plant, opened: Opened) -> None:
    page = opened("/alarms", allow=("422",))
    raised(plant, "drive_lost", "link_poor")
    row = page.locator('[id="alarm-drive_lost@T1"]')
    row.locator("summary").click()
    row.get_by_role("button", name="Shelve").click()
    expect(page.locator(".field-error")).to_contain_text("Enter the reason for shelving")
    row.get_by_label("Reason").fill("The cable is being replaced.")
    row.get_by_role("button", name="Shelve").click()
    expect(row).to_have_count(0)
    page.get_by_role("link", name="Shelved").click()
    row.get_by_role("button", name="Unshelve").click()
    expect(row).to_have_count(0)
    assert plant.machine.alarms[0].state is AlarmState.UNACKNOWLEDGED


def test_the_sound_is_switched_on_here_heard_and_muted(plant: Plant, opened: Opened) -> None:
    page = opened("/alarms")
    raised(plant, "not_stowed")
    expect(page.locator("#says .says-first")).to_contain_text("Not stowed")
    assert page.evaluate("document.documentElement.dataset.sounded") is None
    page.locator("#sound-key").click()
    expect(page.locator("#sound-key")).to_have_attribute("aria-pressed", "true")
    page.wait_for_selector("html[data-sounded]")
    page.locator("#mute-key").click()
    expect(page.locator("#mute-key")).to_contain_text("Muted until")


CUT_WORDS = """texts => {
  const word = document.querySelector(".says-state > *");
  const [state, words] = [word.parentElement, word.closest(".says-words")];
  return texts.filter((text) => {
    word.textContent = text;
    const [inner, outer] = [state.getBoundingClientRect(), words.getBoundingClientRect()];
    return state.scrollWidth > state.clientWidth + 1 || inner.bottom > outer.bottom + 1;
  });
}"""


def test_every_state_is_told_in_full_in_the_bar_in_every_language(plant: Plant, opened: Opened) -> None:
    """The words of each language are put into one page: the bar has no others that differ."""
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, name="South-eastern field behind the workshop")
    raised(plant, "drive_lost", "link_poor", "gateway_down")
    page = opened("/trackers/T1", "phone")
    for size in ("phone", "tablet"):
        resize(page, size)
        for language in LANGUAGES:
            words = [catalogue_of(language).gettext(in_words(word)) for word in StateWord]
            assert page.evaluate(CUT_WORDS, words) == [], (size, language)
