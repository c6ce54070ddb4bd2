"""The time zone of the computer is changed while a tracker tracks: nothing that it does depends on it."""

import time
from collections.abc import Iterator

import pytest

from app.tracker.state.snapshot import ActivityName, EventKind
from app.web.shell.formats import local
from tests.site.plant import Begun
from tests.site.tracking_field import homed

ZONES = ("Pacific/Kiritimati", "Australia/Lord_Howe")


@pytest.fixture
def zone(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """Change the zone of this process, and take its own again afterwards."""
    yield monkeypatch
    monkeypatch.undo()
    time.tzset()


async def test_a_tracker_tracks_on_as_its_twin_that_was_left_alone(
    zone: pytest.MonkeyPatch, begun: Begun
) -> None:
    twin, moved = await begun(homed(tracks=True)), await begun(homed(tracks=True))
    for name in ZONES:
        await twin.forward(seconds=5)
        zone.setenv("TZ", name)
        time.tzset()
        assert time.tzname != ("UTC", "UTC")
        await moved.forward(seconds=5)
        assert moved.tracker().setpoint == twin.tracker().setpoint
        assert moved.tracker().measured == twin.tracker().measured
        assert moved.site.model.now() == twin.site.model.now()
        now = moved.site.model.now()
        assert local(now, "Europe/Istanbul", "%H:%M") == f"{now.hour + 3:02d}:{now.minute:02d}"
    assert not moved.happened(EventKind.CLOCK_JUMPED)
    assert [event.at for event in moved.events] == [event.at for event in twin.events]
    assert moved.tracker().activity is ActivityName.TRACKING
