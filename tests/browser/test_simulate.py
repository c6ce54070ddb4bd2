"""A day is simulated at one press, and the page says meanwhile how long it takes and what comes then."""

from playwright.sync_api import Route, expect

from tests.browser.conftest import Opened

REFUSED = '<div class="outcome-refused"><b>Not done.</b></div>'


def test_a_simulation_says_that_it_goes_on_and_leads_to_its_replay(
    opened: Opened,
) -> None:
    page = opened("/simulate", "tablet", still=True, allow=("409",))
    asked: list[Route] = []
    page.route("**/simulate", lambda route: asked.append(route))
    key, working = page.locator("#simulate-form button"), page.locator("#simulate-working")
    expect(working).to_be_hidden()
    key.dblclick()
    expect(working).to_be_visible()
    expect(working).to_be_in_viewport(ratio=1)
    expect(working).to_contain_text("The replay opens automatically")
    expect(working.get_by_role("link", name="Recordings")).to_have_attribute("href", "/recordings")
    for seconds in range(3):
        expect(page.locator("#simulate-elapsed")).to_have_text(f"{seconds} s so far")
        page.clock.run_for(1_000)
    expect(key).to_be_disabled()
    page.locator("#f-date").press("Enter")
    assert len(asked) == 1, "pressed twice, it is simulated once"
    asked.pop().fulfill(status=409, content_type="text/html", body=REFUSED)
    expect(working).to_be_hidden()
    expect(page.locator("#simulate-outcome")).to_contain_text("Not done.")
    with page.expect_request("**/simulate"):
        key.click()
    expect(working).to_be_visible()
    asked.pop().fulfill(status=204, headers={"HX-Redirect": "/recordings/show-1"})
    page.wait_for_url("**/recordings/show-1")
