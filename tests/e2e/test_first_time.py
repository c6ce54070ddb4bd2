"""Somebody sees the panel for the first time: from an empty database to tracking, a show, a replay, a record.

Nothing but visible words is used: no ids, no addresses but the first. The taps are counted, and
`HELIOPANEL_DOCS=1` writes them and the pictures to docs/start/first-time.md.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect, sync_playwright

from tests.browser.conftest import CHROMIUM, FLAGS
from tests.e2e.chromium import PAGE_READY
from tests.e2e.first_hour import ABOUT, NEXT
from tests.e2e.letters import environment
from tests.e2e.newcomer import DOCS, WRITES_DOCS, Newcomer
from tests.e2e.product import Product
from tests.patience import PATIENCE_MS


@dataclass(frozen=True)
class Town:
    """Where it is day, all year, until an hour of UTC and since the hour of the town before it."""

    until: int
    zone: str
    latitude: tuple[str, str]
    longitude: tuple[str, str]


MOST_TAPS = 40
TAPS_TO_TRACKING = 9 + 2
"""The sides were chosen already for a place in the north and east."""
TABLET = {"width": 1024, "height": 768}
TOWNS = (
    Town(6, "Australia/Brisbane", ("27.4698", "S"), ("153.0251", "E")),
    Town(12, "Europe/Istanbul", ("41.2867", "N"), ("36.33", "E")),
    Town(18, "America/Fortaleza", ("5.7945", "S"), ("35.211", "W")),
    Town(22, "America/Tijuana", ("32.6245", "N"), ("115.4523", "W")),
    Town(24, "Pacific/Honolulu", ("21.3069", "N"), ("157.8583", "W")),
)


def where_the_sun_is_up() -> Town:
    return next(town for town in TOWNS if datetime.now(UTC).hour < town.until)


@pytest.fixture(scope="module")
def town() -> Town:
    """Where the person stands: chosen once, as an hour may pass between two looks at the clock."""
    return where_the_sun_is_up()


@pytest.fixture(scope="module")
def page(product: Product, town: Town) -> Iterator[Page]:
    complaints: list[str] = []
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, env=environment())
        context = browser.new_context(viewport=TABLET, locale="en-GB", timezone_id=town.zone)
        context.set_default_timeout(PATIENCE_MS)
        opened = context.new_page()
        opened.on("pageerror", lambda error: complaints.append(str(error)))
        opened.goto(product.url)
        opened.wait_for_selector(PAGE_READY)
        yield opened
        browser.close()
    assert complaints == []


def commission(person: Newcomer, town: Town) -> None:
    page = person.page
    person.begin("Commissioning")
    person.note("overview")
    person.picture("overview", "The first page, with an empty database")
    person.link("Continue: Location")
    person.sees("Enter the location of the tracker")
    person.note("location")
    for label, (value, side) in (("Latitude", town.latitude), ("Longitude", town.longitude)):
        person.write(label, value)
        person.choose(side)
    expect(page.locator("#preview .map-place")).to_have_count(1)
    person.picture("location", "The location and its sun")
    person.key("Save and next")
    person.sees("Compare both clocks")
    person.note("clock")
    person.picture("clock", "The clock page")
    person.key("Save and next")
    person.sees("Turn the panel to true north")
    person.note("homing")
    person.picture("homing", "The homing page")
    person.key("Start homing")
    expect(page.get_by_text("Both axes are homed and verified.")).to_be_visible()
    person.link("Next")
    person.sees("Choose the tracking mode")
    person.note("mode")
    person.picture("mode", "The mode page")
    person.key("Save and next")
    person.sees("Start tracking, or show the movement")


def track(person: Newcomer) -> None:
    """Start tracking, with which the first hour has taken nine taps, and two for the sides of the Earth."""
    person.begin("Tracking")
    person.note("track")
    person.key("Start tracking")
    assert person.taps == TAPS_TO_TRACKING
    expect(person.page.get_by_label("State")).to_contain_text(
        re.compile("Tracking|Moving to the sun|sunrise")
    )
    person.picture("tracking", "Tracking")
    person.note("tracked")


def show(person: Newcomer) -> None:
    page = person.page
    person.begin("A show")
    person.note("show")
    person.link("Show movement")
    person.sees("Show tracking movement")
    person.write("Date", "2026-06-21")
    person.write("From", "07:30")
    person.write("To", "07:45")
    person.write("Duration of the show", "0.2")
    expect(page.get_by_role("heading", name="This works: 12 s")).to_be_visible()
    person.note("plan")
    person.picture("plan", "The plan of a show that works")
    person.key("Go to start position")
    person.sees("2026-06-21")
    expect(page.get_by_text("Ready at the start", exact=True)).to_be_visible()
    person.picture("ready", "At the start")
    person.key("Show tracking movement")
    expect(page.get_by_text("Running", exact=True).first).to_be_visible()
    person.picture("show", "The show under way")
    expect(page.get_by_role("link", name="Replay")).to_be_visible()
    person.picture("ended", "The show has ended")


def replay(person: Newcomer) -> None:
    page = person.page
    person.begin("A replay")
    person.note("replay")
    person.link("Replay")
    person.sees("Replay:")
    person.key("Play")
    expect(page.get_by_text("Nothing moves")).to_be_visible()
    page.wait_for_selector(".scene[data-frames]")
    person.picture("replay", "The replay")


def sign(person: Newcomer) -> None:
    page = person.page
    person.begin("A signed record")
    person.note("record")
    person.link("Trackers")
    person.link("Open")
    person.picture("live", "The tracker's page")
    person.unfold("More")
    person.link("Record")
    person.sees("Commissioning record")
    person.picture("unsigned", "The record, not signed yet")
    person.write("Name of the technician", "A. Technician")
    person.draw(page.get_by_role("img", name=re.compile("Signature")).first)
    person.picture("sign", "The signature drawn")
    person.key("Sign record")
    expect(page.get_by_role("heading", name="Commissioning is incomplete.")).to_be_visible()
    person.note("asked")
    person.picture("asked", "Open steps before signing")
    person.key("Sign anyway")
    person.sees("Commissioning record: Tracker 1")
    expect(page.get_by_role("img", name="Signature of A. Technician")).to_be_visible()
    person.picture("record", "The signed record")
    with page.expect_download() as download:
        person.link("PDF")
    assert Path(download.value.path()).read_bytes().startswith(b"%PDF-")


def test_a_newcomer_gets_from_an_empty_database_to_a_signed_record(page: Page, town: Town) -> None:
    person = Newcomer(page)
    commission(person, town)
    for part in (track, show, replay, sign):
        part(person)
    person.begin("What next")
    person.note("end")
    assert person.taps <= MOST_TAPS
    taps = f"**{person.taps} taps** in all, one for each field that is typed into."
    told = f"{ABOUT}{taps}\n\n{person.story()}{NEXT}"
    if WRITES_DOCS:
        (DOCS / "start" / "first-time.md").write_text(told)
    assert taps in (DOCS / "start" / "first-time.md").read_text()
