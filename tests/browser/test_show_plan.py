"""The plan of a show is used from the top of its page: a day, the answer, the key; all else comes after."""

from playwright.sync_api import expect

from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.layout import page_end

PATH = "/trackers/T1/show?date=2026-06-21"
GO = '[data-action="go_to_start"]'


def test_answer_and_key_are_seen_without_scrolling(opened: Opened) -> None:
    page = opened(PATH, "phone", touch=True)
    expect(page.locator("#verdict h2")).to_contain_text("This works")
    for name in (".plan-days", "#verdict h2", GO):
        box = page.locator(name).bounding_box()
        assert box is not None
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= page_end(page), name


def test_whoever_presses_check_on_a_phone_is_shown_the_answer(opened: Opened) -> None:
    page = opened(PATH, "phone", touch=True)
    marked = page.locator('.plan-days [aria-current="true"]')
    expect(marked).to_have_text("21 June Solstice")
    page.locator("#f-start").fill("08:00")
    expect(marked).to_have_count(0)
    page.locator("#f-minutes").fill("0.3")
    page.locator("#plan-form button").tap()
    expect(page.locator("#verdict:not([inert]) h2")).to_contain_text("cannot be run")
    expect(page.locator("#verdict h2")).to_be_in_viewport()
    assert SIZES["phone"][1] / 2 > page.locator("#verdict h2").bounding_box()["y"] >= 0  # type: ignore[index]


def test_a_show_is_planned_run_paused_stopped_and_played_again(plant: Plant, opened: Opened) -> None:
    page = opened("/trackers/T1/show", "desk")
    page.get_by_role("link", name="21 June").click()
    expect(page.locator("#f-minutes")).to_have_value("3")
    page.locator("#f-minutes").fill("0.2")
    expect(page.locator("#verdict:not([inert])")).to_contain_text("cannot be run")
    page.locator("#verdict a.key-primary").click()
    expect(page.locator("#verdict")).to_contain_text("This works")
    page.locator(GO).click()
    page.wait_for_url("**/shows/*")
    for phase, key in (
        ("Ready at the start", "run_show"),
        ("Running", "pause_show"),
        ("Paused", "resume_show"),
        ("Running", "stop_show"),
    ):
        expect(page.locator("#show-phase")).to_have_text(phase)
        page.locator(f'[data-action="{key}"]').click()
    expect(page.locator("#show-phase")).to_have_text("Ended")
    kinds = ["save_plan", "go_to_start", "run_show", "pause_show", "resume_show", "stop_show"]
    assert [one.command.kind for one in plant.machine.orders] == kinds
    expect(page.get_by_role("link", name="Replay")).to_be_visible()
