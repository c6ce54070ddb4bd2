"""A day of a field in minutes: weather, faults, repairs; nothing breaks, and the memory does not grow."""

import os
from datetime import UTC, datetime

import pytest

from app.store.writer import DatabaseWriter
from app.tracker.memory.recording import RecordingKind
from app.tracker.state.snapshot import ActivityName
from tests.amount import amount
from tests.patience import TEST_S
from tests.site.direct_writer import DirectWriter
from tests.site.field import Field

TRACKERS = amount(3, 20)
MINUTES = int(os.environ.get("HELIOPANEL_TEST_MINUTES", amount(20, 24 * 60)))
SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "2026"))
BEGIN = datetime(2027, 6, 21, int(os.environ.get("HELIOPANEL_TEST_BEGIN_H", "5")), tzinfo=UTC)
MOST_GROWTH_BYTES = 24 * 1024 * 1024


@pytest.mark.fault(46)
@pytest.mark.timeout(amount(TEST_S, 14_400.0))
async def test_a_field_lives_through_weather_and_faults_and_needs_no_more_memory(
    store: DatabaseWriter,
) -> None:
    field = Field(TRACKERS, BEGIN, seed=SEED, writer=DirectWriter(store))
    await field.live(MINUTES)
    samples = sum(day.sample_count for day in store.recordings(kind=RecordingKind.DAY))
    assert samples >= TRACKERS * MINUTES * 20
    seen = field.seen
    print(
        f"{TRACKERS} trackers, {MINUTES} minutes, {seen.faults} faults; "
        f"memory {[round(size / 1e6) for size in seen.memory_bytes]} MB"
    )
    assert seen.activities >= {ActivityName.TRACKING, ActivityName.STOWING, ActivityName.STOWED}
    assert seen.faults > 0
    settled, last = seen.memory_bytes[amount(0, 12)], seen.memory_bytes[-1]
    assert last - settled < MOST_GROWTH_BYTES
