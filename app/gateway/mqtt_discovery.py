"""What Home Assistant is told so that it finds every tracker by itself: sensors, and buttons if allowed."""

from collections.abc import Iterator, Sequence
from typing import Any

import orjson

from app.base.build import VERSION
from app.gateway.mqtt_messages import OFFLINE, ONLINE, Topics
from app.tracker.state.snapshot import Snapshot

PREFIX = "homeassistant"
SENSORS: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("measured_azimuth_deg", "Azimuth", {"unit_of_measurement": "°", "suggested_display_precision": 1}),
    ("measured_elevation_deg", "Elevation", {"unit_of_measurement": "°", "suggested_display_precision": 1}),
    ("off_sun_deg", "Pointing error", {"unit_of_measurement": "°", "suggested_display_precision": 1}),
    ("activity", "Activity", {"icon": "mdi:solar-panel"}),
)
BUTTONS = (("stop", "Stop"), ("track", "Track the sun"), ("park", "Park"))
CLIENT = "home-assistant"

Announcement = tuple[str, bytes]
"""A topic and what is retained on it; nothing takes an earlier announcement back."""


def announcements(topics: Topics, trackers: Sequence[Snapshot], *, commands: bool) -> dict[str, bytes]:
    """Return everything that is announced about the trackers, by topic."""
    return dict(one for tracker in trackers for one in _of_tracker(topics, tracker, commands=commands))


def _of_tracker(topics: Topics, tracker: Snapshot, *, commands: bool) -> Iterator[Announcement]:
    snapshot = topics.snapshot(tracker.tracker_id)
    for name, label, more in SENSORS:
        value = "{{ value_json." + name + " }}"
        yield _one(
            topics, tracker, "sensor", name, label, {"state_topic": snapshot, "value_template": value, **more}
        )
    problem = {
        "state_topic": snapshot,
        "value_template": "{{ 'ON' if value_json.fault else 'OFF' }}",
        "device_class": "problem",
    }
    yield _one(topics, tracker, "binary_sensor", "fault", "Fault", problem)
    for kind, label in BUTTONS if commands else ():
        payload = orjson.dumps({"type": kind, "client": CLIENT}).decode()
        pressed = {"command_topic": topics.command(tracker.tracker_id), "payload_press": payload, "qos": 1}
        yield _one(topics, tracker, "button", kind, label, pressed)


def _one(
    topics: Topics, tracker: Snapshot, component: str, name: str, label: str, more: dict[str, Any]
) -> Announcement:
    node = f"{topics.base}_{tracker.tracker_id}".replace("/", "_")
    node = "".join(letter if letter.isalnum() or letter in "_-" else "_" for letter in node)
    told = {
        "name": label,
        "unique_id": f"{node}_{name}",
        "availability_topic": topics.availability,
        "payload_available": ONLINE,
        "payload_not_available": OFFLINE,
        "device": {
            "identifiers": [node],
            "name": f"{tracker.tracker_id} {tracker.name}",
            "manufacturer": "Heliopanel",
            "sw_version": VERSION,
        },
        **more,
    }
    return f"{PREFIX}/{component}/{node}/{name}/config", orjson.dumps(told)
