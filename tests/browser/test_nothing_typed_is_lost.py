"""What was typed outlives a test of the connection and the password that is asked for again."""

from playwright.sync_api import Page, Route, expect

from app.link.alarm_orders import ShelveAlarm
from app.link.messages import ConfigureTracker
from tests.browser.conftest import Opened, Plant
from tests.browser.one_panel import opened, plant
from tests.fake_alarms import alarm

__all__ = ["opened", "plant"]

DRIVE = "/trackers/T1/drive"
SAVE = "#drive-form button.key-primary"


def fill(page: Page) -> None:
    page.locator("#f-kind").select_option("modbus-tcp")
    page.locator("#f-host").fill("127.0.0.1")
    page.locator("#f-port").fill("5021")


def expect_typed(page: Page) -> None:
    expect(page.locator("#f-kind")).to_have_value("modbus-tcp")
    expect(page.locator("#f-host")).to_have_value("127.0.0.1")
    expect(page.locator("#f-port")).to_have_value("5021")


def saved(plant: Plant) -> list[ConfigureTracker]:
    return [one.command for one in plant.machine.orders if isinstance(one.command, ConfigureTracker)]


def test_the_password_is_asked_for_here_and_the_save_goes_on(opened: Opened, plant: Plant) -> None:
    page = opened(DRIVE, "tablet", allow=("Failed to load", "htmx:error", "403", "401"))
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
    fill(page)
    page.locator(SAVE).click()
    asked = page.locator("#prove-here")
    expect(asked).to_contain_text("Your entries are kept.")
    expect_typed(page)
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


def test_a_test_of_the_connection_saves_nothing_and_keeps_what_was_typed(opened: Opened) -> None:
    page = opened(DRIVE, "tablet", allow=("Failed to load", "htmx:error", "409"))
    fill(page)
    with page.expect_response("**/drive/test"):
        page.locator('#drive-form button[formaction$="/test"]').click()
    page.goto(page.url.replace(DRIVE, "/prove?back=" + DRIVE))
    page.goto(page.url.split("/prove")[0] + DRIVE)
    expect(page.locator(".kept-note")).to_be_visible()
    expect_typed(page)


def test_an_alarm_is_shelved_with_the_reason_that_was_typed_before_the_password(
    opened: Opened, plant: Plant
) -> None:
    """The form goes as a page: the password is asked for on another, and the list has the reason again."""
    machine = plant.machine
    machine.alarms = (alarm("drive_lost", machine.clock.now()),)
    plant.do(machine.emit)
    needed = [True]

    def to(route: Route, place: str) -> None:
        route.fulfill(status=303, headers={"location": place})

    def shelve(route: Route) -> None:
        if needed[0]:
            to(route, "/prove?back=/alarms")
        else:
            route.fallback()

    def prove(route: Route) -> None:
        if route.request.method != "POST":
            route.fallback()
            return
        needed[0] = False
        to(route, "/alarms")

    page = opened("/alarms", "tablet")
    page.route("**/alarms/shelve", shelve)
    page.route("**/prove*", prove)
    row = page.locator('[id="alarm-drive_lost@T1"]')
    row.locator("summary").click()
    row.get_by_label("Reason").fill("The cable is being replaced.")
    row.get_by_label("Shelve for").select_option("480")
    row.get_by_role("button", name="Shelve").click()
    page.wait_for_url("**/prove?back=/alarms")
    page.locator("input[type=password]").fill("right")
    page.keyboard.press("Enter")
    expect(page.locator(".kept-note")).to_contain_text("Your entries are restored")
    expect(row.get_by_label("Reason")).to_have_value("The cable is being replaced.")
    expect(row.get_by_label("Shelve for")).to_have_value("480")
    row.get_by_role("button", name="Shelve").click()
    expect(row).to_have_count(0)
    (order,) = (one.command for one in machine.orders if isinstance(one.command, ShelveAlarm))
    assert (order.minutes, order.reason) == (480, "The cable is being replaced.")
