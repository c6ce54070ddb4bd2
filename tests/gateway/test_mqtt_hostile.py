"""Commands of hostile bytes over MQTT: each is answered, a stop stops, and the controller goes its way."""

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from app.link.metrics import GatewayStatus
from app.store.store import JournalFilter
from app.tracker.commands.commands import Move
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.gateway.fake_broker import PUBCOMP, PUBREC, PUBREL, FakeBroker, serving
from tests.gateway.rigs import gateway, kept_plant, mqtt_settings, opened
from tests.golden.table import rows
from tests.patience import eventually
from tests.site.plant import Plant

COMMAND, RESULT = b"plant/trackers/T1/command", "plant/trackers/T1/result"
ROWS = [
    (row["payload"].encode("latin-1"), row["result"], row["why"]) for row in rows("world/mqtt_commands.csv")
]
DEEP = b"[" * 10_000 + b"]" * 10_000
STRANGE = (
    b"plant/trackers//command",
    b"plant/trackers/T1/T1/command",
    b"plant/trackers/command",
    b"plant/trackers/T1/result",
    b"other/trackers/T1/command",
    b"plant/trackers/T1/command/",
    b"plant/trackers/" + b"T" * 60_000 + b"/command",
    "plant/trackers/ağaç/command".encode(),
)
MARK = json.dumps({"type": "track", "client": "mark", "key": "mark"}).encode()


@asynccontextmanager
async def commanded(tmp_path: Path) -> AsyncIterator[tuple[Plant, FakeBroker, Any]]:
    broker = FakeBroker()
    async with serving(broker), kept_plant(tmp_path) as (plant, store):
        await plant.commission()
        settings = mqtt_settings(tmp_path, broker.port, mqtt_commands=True)
        async with opened(plant, settings, store) as gateways:
            await eventually(lambda: broker.told("plant/availability"))
            yield plant, broker, store
            assert (await gateway(gateways, "MQTT")).status is GatewayStatus.CONNECTED
            assert broker.connected == 1


def answers(broker: FakeBroker) -> list[dict[str, Any]]:
    return [json.loads(payload) for payload in broker.told(RESULT)]


async def test_every_command_of_the_table_is_a_stop_or_refused_and_none_harms(tmp_path: Path) -> None:
    async with commanded(tmp_path) as (plant, broker, _):
        for payload, result, why in ROWS:
            before, stops = len(broker.told(RESULT)), len(plant.happened(EventKind.STOPPED))
            await plant.ask(Move(Orientation(200.0, 40.0)))
            broker.publish(COMMAND, payload)
            await eventually(lambda before=before: len(broker.told(RESULT)) > before)  # type: ignore[misc]
            answer = answers(broker)[-1]
            told = [reason["code"] for reason in answer["reasons"]]
            assert len(plant.happened(EventKind.STOPPED)) == stops + (result == "stop"), why
            assert (told == ["malformed"]) == (result == "malformed"), (why, answer)
            await plant.forward(seconds=1)
            assert plant.tracker().measured is not None


@pytest.mark.parametrize("rest", [DEEP, b'"' + b"x" * 1_000_000 + b'"'], ids=["deep", "large"])
async def test_a_deep_or_a_large_command_is_refused_shortly_and_a_stop_in_it_stops(
    tmp_path: Path, rest: bytes
) -> None:
    async with commanded(tmp_path) as (plant, broker, store):
        broker.publish(COMMAND, b'{"type":"track","client":"a","more":' + rest + b"}")
        broker.publish(COMMAND, b'{"type":"track","client":"a",' + rest + b":1}")
        await eventually(lambda: len(broker.told(RESULT)) == 2)
        assert all(one["reasons"][0]["code"] == "malformed" for one in answers(broker))
        assert max(map(len, broker.told(RESULT))) < 1000
        await plant.ask(Move(Orientation(200.0, 40.0)))
        broker.publish(COMMAND, b'{"type":"stop","more":' + rest + b"}")
        await eventually(lambda: plant.happened(EventKind.STOPPED))
        await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
        journal = store.journal(JournalFilter(after=0, limit=1000))
        assert max(len(entry.event.message) for entry in journal) < 1000


async def test_many_wrong_fields_are_told_as_some_and_a_topic_that_is_none_of_ours_is_passed_over(
    tmp_path: Path,
) -> None:
    async with commanded(tmp_path) as (plant, broker, _):
        for topic in STRANGE:
            broker.publish(topic, b'{"type":"stop","client":"a"}')
        fields = {f"field{number}": number for number in range(10_000)}
        broker.publish(COMMAND, json.dumps({"type": "track", "client": "a", "key": "1", **fields}).encode())
        await eventually(lambda: broker.told(RESULT))
        assert len(broker.told(RESULT)) == 1
        assert len(broker.told(RESULT)[0]) < 1000
        assert not plant.happened(EventKind.STOPPED)


async def test_an_empty_and_a_retained_command_are_not_carried_out(tmp_path: Path) -> None:
    async with commanded(tmp_path) as (plant, broker, _):
        broker.publish(COMMAND, b"")
        broker.publish(COMMAND, MARK, flags=1)
        await eventually(lambda: broker.told(RESULT))
        assert answers(broker)[0]["reasons"][0]["code"] == "retained"
        assert plant.tracker().activity is ActivityName.HOLDING


async def test_a_command_of_qos_2_that_comes_twice_is_carried_out_once(tmp_path: Path) -> None:
    move = json.dumps({"type": "move", "client": "a", "azimuth_deg": 200, "elevation_deg": 40}).encode()
    async with commanded(tmp_path) as (plant, broker, _):
        broker.publish(COMMAND, move, qos=2, mid=7)
        broker.publish(COMMAND, move, qos=2, mid=7, flags=8)
        await eventually(lambda: broker.acknowledged.count((PUBREC, 7)) == 2)
        broker.session.send(PUBREL, b"\x00\x07", 2)
        broker.session.send(PUBREL, b"\x00\x07", 2)
        await eventually(lambda: broker.acknowledged.count((PUBCOMP, 7)) == 2)
        broker.publish(COMMAND, b'{"type":"stop","client":"a"}')
        await eventually(lambda: len(broker.told(RESULT)) == 2)
        assert len(plant.happened(EventKind.STOPPED)) == 1


@pytest.mark.parametrize(
    ("topic", "commands"),
    [
        (b"plant/trackers/+/command", False),
        (b"plant/trackers/#", True),
        (b"\xff/command", True),
        (b"", True),
    ],
)
async def test_a_topic_against_the_format_ends_one_connection_only(
    tmp_path: Path, topic: bytes, commands: bool
) -> None:
    broker = FakeBroker()
    async with serving(broker), kept_plant(tmp_path) as (plant, store):
        await plant.commission()
        async with opened(plant, mqtt_settings(tmp_path, broker.port, mqtt_commands=commands), store):
            await eventually(lambda: broker.told("plant/availability"))
            broker.publish(topic, b'{"type":"stop","client":"a"}')
            broker.publish(COMMAND, b'{"type":"stop","client":"a"}')
            await eventually(lambda: broker.connected == 2 or plant.happened(EventKind.STOPPED))
            await eventually(lambda: broker.sessions)
            await plant.forward(seconds=1)
            assert plant.tracker().measured is not None
            assert (broker.subscribed > 0) is commands, "no commands are heard unless they are allowed"
