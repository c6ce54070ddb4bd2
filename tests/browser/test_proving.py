"""What was typed into plain forms outlives the password that is asked for, and a session that has ended."""

import re
from datetime import timedelta

import pytest
from playwright.sync_api import Page, expect

from app.access.roles import Role
from app.link.messages import ConfigureTracker
from tests.browser.test_access import HERE, PASSWORD, Door, door, sign_in

__all__ = ["door"]
NEW = "amber-quarry-lantern-3"
STORED = "JSON.stringify({...sessionStorage, ...localStorage})"
LATER, LONG_AFTER = timedelta(minutes=6), timedelta(minutes=31)


def prove(page: Page) -> None:
    """Type the password where it is asked for, beside what was typed."""
    asked = page.locator("#prove-here")
    expect(asked).to_contain_text("Your entries are kept.")
    page.locator("#prove-password").fill(PASSWORD)
    page.keyboard.press("Enter")


def ended(door: Door, name: str) -> None:
    """End every session of somebody."""
    now = door.clock.now()
    for one in [one for one in door.keeper.book.sessions.values() if one.user == name]:
        door.do(lambda one=one: door.keeper.accounts.end_session(HERE, one.digest, now))


def hired(door: Door, name: str) -> None:
    """Add an engineer."""
    now = door.clock.now()
    door.do(lambda: door.keeper.accounts.add(HERE, name, {Role.ENGINEER}, PASSWORD, now))


@pytest.mark.parametrize(("size", "name"), [("phone", "zoe"), ("tablet", "yan")])
def test_a_user_is_added_with_the_password_that_was_typed_before_the_proof(
    size: str, name: str, door: Door
) -> None:
    page = door.signed_in("root", "/users", size)
    door.passes(LATER)
    page.locator("#f-name").fill(name)
    page.locator("#f-password").fill(NEW)
    page.get_by_role("button", name="Add", exact=True).click()
    prove(page)
    expect(page.locator(".outcome-ok").first).to_have_text(f"{name} is added.")
    assert door.do(lambda: name in door.keeper.book.users)
    assert NEW not in page.evaluate(STORED)
    assert PASSWORD not in page.evaluate(STORED)
    newcomer = door.stranger("/login")
    sign_in(newcomer, name, NEW)
    expect(newcomer.locator(".header-who b")).to_have_text(name)


def test_a_token_is_made_with_the_pin_that_was_typed_before_the_proof(door: Door) -> None:
    page = door.signed_in("root", "/tokens")
    door.passes(LATER)
    page.locator("#f-name").fill("Cabinet south")
    page.locator("#f-pin").fill("8642097")
    page.get_by_role("button", name="Create token").click()
    assert "8642097" not in page.evaluate(STORED)
    prove(page)
    expect(page.locator("#new-token")).to_have_text(re.compile("^hp_"))
    (made,) = [one for one in door.keeper.book.tokens.values() if one.name == "Cabinet south"]
    assert made.is_kiosk


def test_a_password_is_changed_after_a_rest_by_the_old_one(door: Door) -> None:
    hired(door, "yusuf")
    page = door.signed_in("yusuf", "/account")
    door.passes(LONG_AFTER)
    page.locator("#f-old").fill(PASSWORD)
    page.locator("#f-new").fill(NEW)
    page.get_by_role("button", name="Change password").click()
    expect(page.locator(".outcome-ok").first).to_contain_text("Password changed.")


def test_an_ended_session_leads_back_to_the_form_with_what_was_typed(door: Door) -> None:
    drive = "/trackers/T1/drive"
    hired(door, "zeynep")
    page = door.signed_in("zeynep", drive)
    page.locator("#f-kind").select_option("modbus-tcp")
    page.locator("#f-host").fill("127.0.0.1")
    ended(door, "zeynep")
    page.locator("#drive-form button.key-primary").click()
    page.wait_for_url(f"**/login?back={drive}")
    sign_in(page, "zeynep", PASSWORD)
    page.wait_for_url(f"**{drive}")
    expect(page.locator(".kept-note")).to_contain_text("Your entries are restored but not saved yet.")
    expect(page.locator("#f-kind")).to_have_value("modbus-tcp")
    expect(page.locator("#f-host")).to_have_value("127.0.0.1")
    page.locator("#drive-form button.key-primary").click()
    expect(page.locator(".outcome-ok").first).to_contain_text("127.0.0.1")
    assert isinstance(door.served.machine.orders[-1].command, ConfigureTracker)
    expect(page.locator(".kept-note")).to_have_count(0)


def test_a_secret_that_an_ended_session_took_is_said_to_be_gone(door: Door) -> None:
    page = door.signed_in("root", "/users", "phone")
    page.locator(".person").filter(has_text="ada").locator("summary").click()
    page.locator("#f-password-ada").fill(NEW)
    ended(door, "root")
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
    page.locator("#f-password-ada").fill(NEW)
    page.get_by_role("button", name="Set the password").click()
    expect(page.locator(".outcome-ok").first).to_contain_text("The password of ada is changed")
    expect(page.locator(".kept-note")).to_have_count(0)
