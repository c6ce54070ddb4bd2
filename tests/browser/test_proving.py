"""What was typed into plain forms outlives the password that is asked for, and a session that has ended."""

import re
from datetime import timedelta

from playwright.sync_api import Page, expect

from app.access.roles import Role
from app.link.messages import ConfigureTracker
from tests.browser.test_access import PASSWORD, Door, door, sign_in

__all__ = ["door"]
NEW = "amber-quarry-lantern-3"
STORED = "JSON.stringify({...sessionStorage, ...localStorage})"
LATER = timedelta(minutes=6)


def prove(page: Page) -> None:
    """Type the password where it is asked for, beside what was typed."""
    asked = page.locator("#prove-here")
    expect(asked).to_contain_text("Your entries are kept.")
    page.locator("#prove-password").fill(PASSWORD)
    page.keyboard.press("Enter")


def test_a_user_and_a_token_are_made_with_the_secrets_that_were_typed_before_the_proof(door: Door) -> None:
    page = door.signed_in("root", "/users", "phone")
    door.passes(LATER)
    page.locator("#f-name").fill("zoe")
    page.locator("#f-password").fill(NEW)
    page.get_by_role("button", name="Add", exact=True).click()
    prove(page)
    expect(page.locator(".outcome-ok").first).to_have_text("zoe is added.")
    assert NEW not in page.evaluate(STORED)
    assert PASSWORD not in page.evaluate(STORED)
    page.goto(f"{door.url}/tokens")
    door.passes(LATER)
    page.locator("#f-name").fill("Cabinet south")
    page.locator("#f-pin").fill("8642097")
    page.get_by_role("button", name="Create token").click()
    assert "8642097" not in page.evaluate(STORED)
    prove(page)
    expect(page.locator("#new-token")).to_have_text(re.compile("^hp_"))
    (made,) = [one for one in door.keeper.book.tokens.values() if one.name == "Cabinet south"]
    assert made.is_kiosk
    newcomer = door.stranger("/login")
    sign_in(newcomer, "zoe", NEW)
    expect(newcomer.locator(".header-who b")).to_have_text("zoe")


def test_an_ended_session_leads_back_to_the_form_with_what_was_typed(door: Door) -> None:
    drive = "/trackers/T1/drive"
    door.add("zeynep", Role.ENGINEER)
    page = door.signed_in("zeynep", drive)
    page.locator("#f-kind").select_option("modbus-tcp")
    page.locator("#f-host").fill("127.0.0.1")
    door.end("zeynep")
    page.locator("#drive-form button.key-primary").click()
    page.wait_for_url(f"**/login?back={drive}")
    sign_in(page, "zeynep", PASSWORD)
    page.wait_for_url(f"**{drive}")
    expect(page.locator(".kept-note")).to_contain_text("Your entries are restored but not saved yet.")
    expect(page.locator("#f-kind")).to_have_value("modbus-tcp")
    page.locator("#drive-form button.key-primary").click()
    expect(page.locator(".outcome-ok").first).to_contain_text("127.0.0.1")
    assert isinstance(door.served.machine.orders[-1].command, ConfigureTracker)
    expect(page.locator(".kept-note")).to_have_count(0)


def test_a_secret_that_an_ended_session_took_is_said_to_be_gone(door: Door) -> None:
    page = door.signed_in("root", "/users", "phone")
    page.locator(".person").filter(has_text="ada").locator("summary").click()
    page.locator("#f-password-ada").fill(NEW)
    door.end("root")
    page.get_by_role("button", name="Set the password").click()
    page.wait_for_url("**/login?back=/users")
    assert NEW not in page.evaluate(STORED)
    sign_in(page, "root", PASSWORD)
    page.wait_for_url("**/users")
    expect(page.locator(".kept-note")).to_have_text(
        re.compile("^Passwords and other secrets are not kept: enter")
    )
    expect(page.locator("#f-password-ada")).to_be_visible()
    expect(page.locator("#f-password-ada")).to_have_value("")
