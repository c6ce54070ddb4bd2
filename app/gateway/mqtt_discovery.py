"""What Home Assistant is told so that it finds every tracker by itself: sensors, and buttons if allowed."""

import re
from collections.abc import Iterator, Sequence
from hashlib import sha256
from typing import Any

import orjson

from app.base.build import VERSION
from app.gateway.mqtt_messages import OFFLINE, ONLINE, Topics
from app.tracker.state.snapshot import Snapshot

PREFIX = "homeassistant"
NOT_ALLOWED = re.compile(r"[^A-Za-z0-9_-]")
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


def node_id(base: str, tracker_id: str) -> str:
    """Return how Home Assistant knows a tracker; it ignores ids of anything but `[A-Za-z0-9_-]`.

    A base topic with other letters has a digest of it in the id, as two of them may leave the same rest.
    One of ASCII has none: its ids are in use.
    """
    node = NOT_ALLOWED.sub("_", f"{base}_{tracker_id}")
    return node if base.isascii() else f"{node}_{sha256(base.encode()).hexdigest()[:16]}"


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
    node = node_id(topics.base, tracker.tracker_id)
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
