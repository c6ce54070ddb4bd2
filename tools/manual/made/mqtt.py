"""Topics, payloads, and commands of MQTT, from what builds and reads them."""

import inspect
from collections.abc import Iterator
from typing import Any

import orjson

from app.gateway.mqtt_commands import MESSAGES
from app.gateway.mqtt_discovery import announcements
from app.gateway.mqtt_messages import Topics, columns_payload, site_payload, tracker_payload
from app.tracker.state.snapshot import SiteSnapshot
from tests.fakes import FakeMachine
from tools.manual.made.markdown import code, page, table

INTRODUCTION = """Topics are below `HELIOPANEL_MQTT_BASE_TOPIC`, here `heliopanel`; `T1` stands for the id of
a tracker. Payloads are JSON. Units are in the names, instants are ISO 8601, and unknown values are
`null`. [MQTT](../integrate/mqtt.md) describes the setup, retained messages, and events."""
ARGUMENTS = {"tracker_id": "T1", "alarm_id": "ALARM"}
NO_TOPIC = ("commands", "addressed")


def mqtt_page() -> str:
    """Return the page."""
    site = FakeMachine().emit()
    (tracker, *_), topics = site.trackers, Topics("heliopanel")
    payloads = {
        topics.site: site_payload(site),
        topics.snapshot("T1"): tracker_payload(site, tracker),
        topics.columns: columns_payload(site),
    }
    return page(
        "MQTT topics",
        INTRODUCTION,
        "## Topics\n\n" + table(("topic", "here"), _topics(topics)),
        "## Fields\n\n"
        + table(("topic", "fields"), ((code(name), _fields(told)) for name, told in payloads.items())),
        "## Commands\n\n" + table(("field", "value", "needed"), _commands()),
        "## Home Assistant\n\n" + table(("topic", "name"), _announced(topics, site)),
    )


def _topics(topics: Topics) -> Iterator[tuple[str, str]]:
    for name, member in inspect.getmembers(Topics):
        if name.startswith("_") or name in (*NO_TOPIC, "base"):
            continue
        told = inspect.getdoc(member) or ""
        where = getattr(topics, name)
        if callable(where):
            where = where(*(ARGUMENTS[one] for one in inspect.signature(where).parameters))
        yield code(where), told.removeprefix("Return ").removeprefix("where ").rstrip(".")


def _fields(payload: bytes) -> str:
    return ", ".join(code(name) for name in orjson.loads(payload))


def _commands() -> Iterator[tuple[str, str, str]]:
    """Return the fields of a command; those of one kind alone name it."""
    kinds: list[dict[str, Any]] = list(MESSAGES.json_schema()["$defs"].values())
    types = [one for kind in kinds for one in _choices(kind["properties"]["type"])]
    yield code("type"), ", ".join(code(one) for one in types), "yes"
    shared = set.intersection(*(set(kind["properties"]) for kind in kinds)) - {"type"}
    fields = {
        name: (kind, told, name in shared)
        for kind in kinds
        for name, told in kind["properties"].items()
        if name != "type"
    }
    for name, (kind, told, is_shared) in fields.items():
        always = "yes" if name in kind["required"] else "no"
        only = (
            ""
            if is_shared
            else f", {' or '.join(code(one) for one in _choices(kind['properties']['type']))} only"
        )
        yield code(name), _value(told), always + only


def _choices(told: dict[str, Any]) -> list[str]:
    return told.get("enum") or [told["const"]]


def _value(told: dict[str, Any]) -> str:
    told = next((one for one in told.get("anyOf", ()) if one["type"] != "null"), told)
    names = {"minimum": "from", "exclusiveMinimum": "above", "maximum": "to", "exclusiveMaximum": "below"}
    names |= {"minLength": "at least", "maxLength": "at most"}
    bounds = [f"{word} {told[name]:g}" for name, word in names.items() if name in told]
    letters = ["letters"] if "maxLength" in told else []
    return ", ".join(
        (told.get("format", told["type"]), " ".join((" and ".join(bounds), *letters)))
    ).removesuffix(", ")


def _announced(topics: Topics, site: SiteSnapshot) -> Iterator[tuple[str, str]]:
    for topic, told in announcements(topics, site.trackers[:1], commands=True).items():
        yield code(topic), orjson.loads(told)["name"]
