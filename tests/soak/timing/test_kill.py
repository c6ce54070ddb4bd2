"""Either process killed again and again, as `make bench` does it: nothing is lost, and the drive stops."""

import os

import pytest

from bench.kill import Size, measure

KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "2"))


@pytest.mark.timeout(60 + 15 * KILLS)
def test_no_kill_loses_a_tick_a_frame_or_a_change_and_the_drive_stops() -> None:
    rows = measure(Size(controller=KILLS, panel=2))
    assert len(rows) == 3
    assert not [row for row in rows if "missed" in row.verdict]
