"""A page from before the controller's last start says so and is loaded again in place."""

import re

import pytest
from playwright.sync_api import expect

from tests.browser.conftest import Opened, Plant

SETTINGS = "/trackers/T1/settings"
SHOWN_MS = 1500
"""So long the page says that it is loaded again."""
LATER = re.compile(r"\.second-boot$")


@pytest.mark.fault(61)
def test_a_page_from_before_a_restart_is_loaded_again_in_place(plant: Plant, opened: Opened) -> None:
    page = opened(SETTINGS, still=True)
    plant.do(plant.machine.start_again)
    expect(page.locator("#outdated-banner")).to_be_visible()
    page.clock.run_for(SHOWN_MS - 1)
    assert page.evaluate("document.documentElement.dataset.page").endswith(".fake-boot")
    page.clock.run_for(1)
    expect(page.locator("html")).to_have_attribute("data-page", LATER)
    expect(page.locator("#outdated-banner")).to_be_hidden()


def test_a_page_on_which_was_typed_is_loaded_again_when_it_suits(plant: Plant, opened: Opened) -> None:
    page = opened(SETTINGS, still=True)
    page.locator("input[type=text]").first.fill("North field 7")
    plant.do(plant.machine.start_again)
    expect(page.locator("#outdated-banner")).to_be_visible()
    page.clock.run_for(2 * SHOWN_MS)
    expect(page.locator("input[type=text]").first).to_have_value("North field 7")
    page.locator("#outdated-load").click()
    expect(page.locator("html")).to_have_attribute("data-page", LATER)


@pytest.mark.fault(61)
def test_an_order_of_an_outdated_page_is_refused_and_the_page_is_loaded_again(
    plant: Plant, opened: Opened
) -> None:
    page = opened("/trackers/T1", still=True, allow=("409", "WebGL"))
    page.evaluate("document.documentElement.dataset.page = '0123456789ab.fake-boot'")
    page.evaluate("sessionStorage.setItem('loaded-again-at', Date.now() + 24 * 3600 * 1000)")
    park = page.locator('.slots form[action="/trackers/T1/park"]')
    park.locator("button").click()
    expect(park.locator(".outcome")).to_contain_text("This page is outdated")
    page.clock.run_for(SHOWN_MS)
    expect(page.locator("html")).not_to_have_attribute("data-page", "0123456789ab.fake-boot")
    assert plant.orders("park") == []


@pytest.mark.fault(61)
def test_a_page_that_answers_a_form_is_loaded_again_without_sending_the_form(
    plant: Plant, opened: Opened
) -> None:
    page = opened("/network", still=True, allow=("422",))
    page.locator("input[name=port]").fill("99999")
    with page.expect_response(lambda answer: answer.status == 422):
        page.get_by_role("button", name="Try this for 60 s").click()
    expect(page.locator("#link-words")).to_have_text("live")
    sent: list[str] = []
    page.on("request", lambda request: sent.append(request.method))
    plant.do(plant.machine.start_again)
    expect(page.locator("#outdated-banner")).to_be_visible()
    page.clock.run_for(SHOWN_MS)
    expect(page.locator("html")).to_have_attribute("data-page", LATER)
    assert "POST" not in sent
