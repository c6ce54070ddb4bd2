"""Instants at which 32 bits end are stored, found and given back as they are, on both databases."""

from datetime import UTC, datetime, timedelta

import pytest

from app.store.engine import open_writer
from app.store.store import JournalFilter
from app.tracker.state.snapshot import Event, EventKind

NTP_ERA = datetime(2036, 2, 7, 6, 28, 16, tzinfo=UTC)
UNIX_32_BIT = datetime(2038, 1, 19, 3, 14, 8, tzinfo=UTC)
NO_LEAP_DAY = datetime(2100, 3, 1, tzinfo=UTC)
UNSIGNED_32_BIT = datetime(2106, 2, 7, 6, 28, 16, tzinfo=UTC)
SECOND = timedelta(seconds=1)


@pytest.mark.fault(32)
@pytest.mark.parametrize("era", [NTP_ERA, UNIX_32_BIT, NO_LEAP_DAY, UNSIGNED_32_BIT])
def test_the_journal_knows_no_end_of_an_era(url: str, era: datetime) -> None:
    around = [era - SECOND, era, era + SECOND]
    writer = open_writer(url)
    writer.append_events(
        [Event(at, EventKind.STOPPED, "T1", f"Stopped at {at.isoformat()}.", "technician") for at in around]
    )
    everything = [entry.event.at for entry in writer.journal(JournalFilter())]
    after = [entry.event.at for entry in writer.journal(JournalFilter(start=era))]
    before = [entry.event.at for entry in writer.journal(JournalFilter(end=era - SECOND))]
    writer.close()
    assert everything == around[::-1]
    assert after == [era + SECOND, era]
    assert before == [era - SECOND]
