"""What is told over MQTT: topics and JSON payloads, units in the names, unknown values null."""

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import orjson

from app.alarms.urgency import own_headline
from app.gateway.outbox import recording_state
from app.store.store import JournalEntry
from app.tracker.memory.recording import RecordingInfo
from app.tracker.state.snapshot import Pair, SiteSnapshot, Snapshot
from app.tracker.values.alarm_words import AlarmNow

ADDRESS = re.compile(r"[\w-]{1,40}", re.ASCII)
"""What may stand where a topic names a tracker; whether there is one is for the site to say."""
ONLINE, OFFLINE = "online", "offline"
COLUMNS = (
    "tracker_id", "state", "activity", "tracking_on", "target_azimuth_deg", "target_elevation_deg",
    "measured_azimuth_deg", "measured_elevation_deg", "following_error_deg", "off_sun_deg",
    "position_age_s", "in_position", "homed", "fault",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Topics:
    """Every topic of one machine, below the levels that the settings give."""

    base: str

    @property
    def availability(self) -> str:
        """Return where `online` or `offline` is retained."""
        return f"{self.base}/availability"

    @property
    def site(self) -> str:
        """Return where the site is told."""
        return f"{self.base}/site"

    @property
    def columns(self) -> str:
        """Return where all trackers are told in one message of columns."""
        return f"{self.base}/columns"

    @property
    def events(self) -> str:
        """Return where the journal is told."""
        return f"{self.base}/events"

    def alarm(self, alarm_id: str) -> str:
        """Return where one alarm is retained while it stands."""
        return f"{self.base}/alarms/{alarm_id}"

    @property
    def recordings(self) -> str:
        """Return where recordings are announced."""
        return f"{self.base}/recordings"

    @property
    def commands(self) -> str:
        """Return the filter that every tracker's commands match."""
        return self.command("+")

    def snapshot(self, tracker_id: str) -> str:
        """Return where one tracker is told."""
        return f"{self.base}/trackers/{tracker_id}/snapshot"

    def command(self, tracker_id: str) -> str:
        """Return where one tracker takes commands."""
        return f"{self.base}/trackers/{tracker_id}/command"

    def result(self, tracker_id: str) -> str:
        """Return where it is told what came of a command."""
        return f"{self.base}/trackers/{tracker_id}/result"

    def addressed(self, topic: str) -> str | None:
        """Return the tracker of a command's topic, None if it is no such topic or names nothing sensible."""
        tracker_id = topic.removeprefix(f"{self.base}/trackers/").removesuffix("/command")
        is_ours = topic == self.command(tracker_id)
        return tracker_id if is_ours and ADDRESS.fullmatch(tracker_id) else None


def tracker_payload(site: SiteSnapshot, tracker: Snapshot) -> bytes:
    """Return one tracker now."""
    fault = tracker.fault
    told = _values(tracker) | {
        "boot_id": site.boot_id,
        "sequence": site.sequence,
        "at": tracker.at,
        "name": tracker.name,
        "activity_text": tracker.activity_text,
        "mode": tracker.mode,
        "fault": None if fault is None else asdict(fault),
        "waiting": [asdict(reason) for reason in tracker.waiting],
        "message": None if (first := own_headline(tracker)) is None else asdict(first),
    }
    return orjson.dumps(told)


def columns_payload(site: SiteSnapshot) -> bytes:
    """Return all trackers as columns of equal length, in the order of `tracker_id`."""
    rows = [_values(tracker) for tracker in site.trackers]
    return orjson.dumps(
        {
            "boot_id": site.boot_id,
            "sequence": site.sequence,
            "at": site.at,
            "columns": {name: [row[name] for row in rows] for name in COLUMNS},
        }
    )


def site_payload(site: SiteSnapshot) -> bytes:
    """Return the site now; weather that is stale or impossible is told as null."""
    weather = None if site.weather is None else site.weather.usable
    sun = site.sun
    told: dict[str, Any] = {
        "boot_id": site.boot_id,
        "sequence": site.sequence,
        "at": site.at,
        "site_name": site.site_name,
        "time_zone": site.time_zone,
        "location": None if site.location is None else asdict(site.location),
        "clock_trusted": site.clock.trusted,
        "sun_azimuth_deg": None if sun is None else sun.azimuth_deg,
        "sun_elevation_deg": None if sun is None else sun.apparent_elevation_deg,
        "weather": None if weather is None else asdict(weather),
        "alarm_counts": asdict(site.alarm_counts),
        "message": asdict(site.messages[0]) if site.messages else None,
        "weather_age_s": None if site.weather is None else site.weather.age_s,
        "trackers": [tracker.tracker_id for tracker in site.trackers],
    }
    return orjson.dumps(told)


def event_payload(series: str, entry: JournalEntry) -> bytes:
    """Return one entry of the journal; `series` and `sequence` together name it once and for all."""
    return orjson.dumps({"series": series, "sequence": entry.number, **asdict(entry.event)}, default=str)


def alarm_payload(alarm: AlarmNow) -> bytes:
    """Return one alarm as it stands."""
    return orjson.dumps(alarm)


def recording_payload(recording: RecordingInfo) -> bytes:
    """Return the head of a recording that has begun or ended."""
    return orjson.dumps({"state": recording_state(recording), **asdict(recording)})


def _values(tracker: Snapshot) -> dict[str, Any]:
    target_azimuth_deg, target_elevation_deg = _angles(tracker.target)
    azimuth_deg, elevation_deg = _angles(tracker.measured)
    values: Sequence[object] = (
        tracker.tracker_id,
        tracker.state,
        tracker.activity,
        tracker.tracking_on,
        target_azimuth_deg,
        target_elevation_deg,
        azimuth_deg,
        elevation_deg,
        tracker.following_error_deg,
        tracker.off_sun_deg,
        tracker.position_age_s,
        tracker.in_position,
        tracker.homed,
        None if tracker.fault is None else tracker.fault.code,
    )
    return dict(zip(COLUMNS, values, strict=True))


def _angles(pair: Pair | None) -> tuple[float | None, float | None]:
    return (None, None) if pair is None else (pair.azimuth_deg, pair.elevation_deg)
