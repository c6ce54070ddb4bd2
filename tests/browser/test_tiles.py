"""A field on the overview: 48 trackers on a tablet, gray when normal, the one in danger first."""

import pytest
from playwright.sync_api import expect

from app.tracker.state.snapshot import ActivityName, Pair
from app.tracker.values.reason import Reason
from tests.browser.conftest import Opened, Plant, now
from tests.fake_alarms import alarm
from tests.fake_data import commissioned
from tests.fake_tracker import FakeTracker

WHY = Reason("not_stowed", "South field does not stow.", "Stow it by hand.")
IN_SIGHT = """() => [...document.querySelectorAll(".tile")]
  .filter((one) => one.getBoundingClientRect().bottom <= innerHeight).length"""


@pytest.fixture
def field(plant: Plant) -> Plant:
    """A field of 48 in a storm: 45 are stowed, 2 stow, 1 does not."""

    def grow() -> None:
        for number in range(1, 49):
            name = f"T{number:02}"
            tracker = FakeTracker(commissioned(name, "Row", tracking=False), Pair(180.0, 90.0))
            tracker.activity = ActivityName.STOWED
            plant.machine.trackers[name] = tracker
        for name in [name for name in plant.machine.trackers if len(name) == 2]:
            del plant.machine.trackers[name]
        plant.machine.trackers["T12"].activity = ActivityName.STOWING
        plant.machine.trackers["T44"].activity = ActivityName.STOWING
        plant.machine.trackers["T31"].activity = ActivityName.STOWING
        plant.machine.trackers["T31"].not_stowed = WHY
        plant.machine.emit()

    now(plant, grow)
    return plant


def test_a_field_is_seen_on_one_screen_and_the_one_in_danger_first(field: Plant, opened: Opened) -> None:
    page = opened("/", "tablet")
    urgent = page.locator("#site-urgent")
    expect(urgent).to_contain_text("T31 Row: Not stowed")
    expect(page.locator(".tile").first).to_contain_text("T31")
    expect(page.locator('.tile[data-priority="1"]')).to_have_count(1)
    expect(page.locator('.tile[data-look="under-way"]')).to_have_count(2)
    assert page.evaluate(IN_SIGHT) >= 40
    page.locator("#urgent-open").click()
    expect(page).to_have_url(f"{field.url}/trackers/T31")


def test_tiles_and_counts_follow_what_happens(field: Plant, opened: Opened) -> None:
    page = opened("/", "tablet")
    counts = page.locator("#counts")
    expect(counts.locator('[data-state="not_stowed"] b')).to_have_text("1")
    expect(counts.locator('[data-state="stowed"] b')).to_have_text("45")
    expect(counts.locator('[data-state="stowing"] b')).to_have_text("2")

    def arrive() -> None:
        for name in ("T12", "T31"):
            field.machine.trackers[name].activity = ActivityName.STOWED
        field.machine.trackers["T31"].not_stowed = None
        field.machine.alarms = (alarm("drive_lost", field.machine.clock.now(), "T07"),)
        field.machine.trackers["T08"].position = Pair(90.0, 30.0)

    field.do(arrive)
    expect(counts.locator('[data-state="stowed"] b')).to_have_text("47")
    expect(counts.locator('[data-state="not_stowed"]')).to_be_hidden()
    expect(page.locator("#site-urgent")).to_have_attribute("data-tracker", "T07")
    expect(page.get_by_role("button", name="Stow T07")).to_be_hidden()
    tile = page.locator('[data-tile="T07"]')
    expect(tile).to_have_attribute("data-priority", "2")
    expect(tile.locator("i")).to_have_text("2")
    expect(page.get_by_role("link", name="T07 Stowed Drive does not answer")).to_be_visible()
    panel = page.locator('[data-tile="T08"] .tile-panel')
    expect(panel).to_have_attribute("transform", "translate(16 12) rotate(-60)")
