"""What was typed outlives a test of the connection and the password that is asked for again."""

from playwright.sync_api import Route, expect

from app.link.messages import ConfigureTracker
from tests.browser.conftest import Opened, Plant

DRIVE = "/trackers/T1/drive"
SAVE = "#drive-form button.key-primary"


def saved(plant: Plant) -> list[ConfigureTracker]:
    return [one.command for one in plant.machine.orders if isinstance(one.command, ConfigureTracker)]


def test_the_password_is_asked_for_here_and_the_save_goes_on(opened: Opened, plant: Plant) -> None:
    page = opened(DRIVE, "tablet", allow=("Failed to load", "htmx:error", "403", "401", "409"))
    needed, passwords = [True], []

    def save(route: Route) -> None:
        if route.request.method == "POST" and needed[0]:
            route.fulfill(status=403, headers={"Proof-Needed": "1"}, body="<p>of weight</p>")
        else:
            route.fallback()

    def prove(route: Route) -> None:
        passwords.append(route.request.post_data or "")
        right = "password=right" in passwords[-1]
        needed[0] = not right
        route.fulfill(status=303 if right else 401, headers={"location": "/"} if right else {})

    page.route(f"**{DRIVE}", save)
    page.route("**/prove", prove)
    page.locator("#f-kind").select_option("modbus-tcp")
    page.locator("#f-host").fill("127.0.0.1")
    page.locator("#f-port").fill("5021")
    with page.expect_response("**/drive/test"):
        page.locator('#drive-form button[formaction$="/test"]').click()
    assert not saved(plant), "a test of the connection saves nothing"
    expect(page.locator(".htmx-request")).to_have_count(0)
    page.locator(SAVE).click()
    asked = page.locator("#prove-here")
    expect(asked).to_contain_text("Your entries are kept.")
    expect(page.locator("#f-port")).to_have_value("5021")
    page.locator("#prove-password").fill("wrong")
    page.keyboard.press("Enter")
    expect(asked).to_contain_text("The password is wrong.")
    assert not saved(plant)
    page.locator("#prove-password").fill("right")
    page.keyboard.press("Enter")
    expect(page.locator(".outcome-ok").first).to_contain_text(
        "Drive: Modbus TCP, by network, 127.0.0.1:5021, unit 1."
    )
    (order,) = saved(plant)
    assert (order.config.drive.kind, order.config.drive.port) == ("modbus-tcp", 5021)
    expect(page.locator(".kept-note")).to_have_count(0)
