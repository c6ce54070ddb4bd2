"""Any page of the database file may be lost: the start says so, or what it tells is what was stored."""

import random
import shutil
from contextlib import suppress
from pathlib import Path

import pytest

from app.alarms.alarm import Alarm
from app.audit.entry import Entry
from app.store.chunks import encode_all
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, StoreDamaged, StoreFailed
from app.store.writer import DatabaseWriter
from tests.store.samples import NOON, SITE, event, tracker
from tests.store.tracked_day import day_info, tracked_day

PAGE_BYTES = 4096
MOST_PAGES = 60
EVENTS = 150


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database with something in every table that matters, closed in order."""
    path = tmp_path_factory.mktemp("whole") / "heliopanel.db"
    url = f"sqlite:///{path}"
    upgrade(url)
    writer = open_writer(url)
    writer.save_site(SITE, [event(number) for number in range(EVENTS)])
    for number in range(1, 4):
        writer.save_tracker(tracker(f"T{number}", f"Tracker {number}"))
    writer.begin_recording(day_info())
    writer.append_frames("day-1", tracked_day(4000))
    for number in range(40):
        entry = Entry(NOON, number, "boot", "trusted", "Ayşe", "panel", "", "rename", "site", "{}")
        with writer.audited(entry):
            writer.append_events([event(EVENTS + number)])
    writer.close()
    return path


def told(store: DatabaseWriter) -> tuple[object, ...]:
    """Return all that the machine starts from."""
    alarms: list[Alarm] = store.standing_alarms()
    return store.site(), store.trackers(), store.journal(JournalFilter(limit=1000)), alarms


@pytest.mark.fault(51)
def test_a_page_of_rubbish_is_told_at_the_start_or_harms_nothing(whole: Path, tmp_path: Path) -> None:
    url = f"sqlite:///{whole}"
    store = open_writer(url)
    before, frames = told(store), encode_all(store.frames("day-1"))
    store.close()
    pages = range(whole.stat().st_size // PAGE_BYTES)
    assert len(pages) > 30
    chance, damaged = random.Random(51), 0
    for page in sorted(chance.sample(pages, min(MOST_PAGES, len(pages)))):
        path = tmp_path / f"{page}.db"
        shutil.copyfile(whole, path)
        with path.open("r+b") as file:
            file.seek(page * PAGE_BYTES)
            file.write(chance.randbytes(PAGE_BYTES))
        try:
            upgrade(f"sqlite:///{path}")
            store = open_writer(f"sqlite:///{path}")
        except StoreDamaged:
            damaged += 1
            continue
        assert told(store) == before, f"page {page}"
        with suppress(StoreFailed):
            assert encode_all(store.frames("day-1")) == frames, f"page {page}"
        store.close()
    assert damaged >= 15
