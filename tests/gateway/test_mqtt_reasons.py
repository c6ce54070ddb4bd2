"""Whatever a broker may answer by its format is told with what to do, and costs no event."""

import itertools
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from aiomqtt import MqttError, ProtocolVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.reasoncodes import ReasonCode

from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.gateway.gateways import Gateways
from app.gateway.mqtt import CUT_OFF_OFTEN, FIRST_DELAY, LONGEST_DELAY, LONGEST_WHEN_TAKEN_OVER, next_delay
from app.gateway.mqtt_client import broker_client
from app.gateway.mqtt_reasons import told_reason
from app.link.messages import RenameSite
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.store.store import JournalFilter, Writer
from tests.captured_logs import capture_logs
from tests.gateway.fake_broker import FakeBroker, serving
from tests.gateway.rigs import kept_plant, mqtt_settings, opened, until
from tests.golden.table import rows
from tests.patience import eventually
from tests.site.plant import Plant

NOON = datetime(2026, 11, 28, 12, tzinfo=UTC)
ROWS = rows("world/broker_reasons.csv")
PACKETS = {
    "connack": PacketTypes.CONNACK,
    "disconnect": PacketTypes.DISCONNECT,
    "puback": PacketTypes.PUBACK,
    "suback": PacketTypes.SUBACK,
}
UNSUPPORTED_VERSION = 0x84
"""It is told by the connection in MQTT 3.1.1 that follows."""
BEFORE = ("Messages on plant/events", "No commands are received")
"""What stands before the sentence of a reason that says nothing."""


def is_connected(metrics: GatewayMetrics) -> bool:
    return metrics.status is GatewayStatus.CONNECTED


@asynccontextmanager
async def telling(
    tmp_path: Path, broker: FakeBroker, **more: Any
) -> AsyncIterator[tuple[Plant, Gateways, Writer]]:
    async with (
        serving(broker),
        kept_plant(tmp_path) as (plant, store),
        opened(plant, mqtt_settings(tmp_path, broker.port, **more), store) as gateways,
    ):
        await until(gateways, lambda metrics: is_connected(metrics) or metrics.error != "")
        yield plant, gateways, store


def test_the_table_has_every_code_that_a_broker_may_send() -> None:
    listed = {(row["at"], int(row["code"], 16)) for row in ROWS}
    known = {
        (name, code)
        for name, packet in PACKETS.items()
        for code, names in ReasonCode.names.items()
        if code >= 0x80 and any(packet in packets for packets in names.values())
    }
    assert known ^ listed == {("connack", UNSUPPORTED_VERSION)}


def test_every_code_is_told_with_what_to_do() -> None:
    for row in ROWS:
        told = told_reason(
            int(row["code"], 16), where="here", client_id="heliopanel", base="plant", server="other.example"
        )
        assert row["words"] in str(told) or row["words"].startswith(BEFORE), row


async def test_refused_and_ended_connections_are_told_and_cost_no_event(tmp_path: Path) -> None:
    broker = FakeBroker(connack=0x9C, server="other.example")
    async with telling(tmp_path, broker) as (plant, gateways, _):
        seen = await until(gateways, lambda metrics: "another server: other.example" in metrics.error)
        assert seen.status is GatewayStatus.CONNECTING
        broker.connack = 0
        await until(gateways, is_connected)
        with capture_logs() as lines:
            broker.connack = 0x88
            broker.session.farewell(0x8B)
            await eventually(lambda: any(line.get("code") == 0x8B for line in lines))
        broker.connack = 0
        assert any("started again" in line["told"] for line in lines if line.get("code") == 0x8B), lines
        await until(gateways, is_connected)
        await _event_arrives(plant, broker)


async def _event_arrives(plant: Plant, broker: FakeBroker, name: str = "Told") -> None:
    await plant.ask(RenameSite(name))
    await eventually(lambda: any(name.encode() in payload for payload in broker.told("plant/events")))


def in_journal(store: Writer) -> list[int]:
    return [entry.number for entry in store.journal(JournalFilter(after=0, limit=1000))]


def in_events(broker: FakeBroker) -> list[int]:
    """Return the numbers of the events that were told, as a receiver keeps them: a repeat is dropped."""
    return list(dict.fromkeys(json.loads(payload)["sequence"] for payload in broker.told("plant/events")))


async def test_refused_events_are_kept_until_they_are_accepted_and_hold_up_no_snapshot(
    tmp_path: Path,
) -> None:
    rules = {"plant/events": 0x80}
    broker = FakeBroker(puback=lambda topic, payload: rules.get(topic, 0))
    async with telling(tmp_path, broker) as (plant, gateways, store):
        await plant.ask(RenameSite("North"))
        await until(gateways, lambda metrics: "Messages on plant/events are not" in metrics.error)
        assert broker.connected == 1, "what is refused does not end the connection"
        snapshots = len(broker.told("plant/site"))
        await eventually(lambda: len(broker.told("plant/site")) > snapshots + 5)
        assert len([one for one in broker.refused if b"North" in one[1]]) <= 2, "not at once again"
        rules.clear()
        await plant.ask(RenameSite("South"))
        await until(gateways, lambda metrics: not metrics.error and metrics.waiting == 0)
        told = in_events(broker)
        assert told == in_journal(store)[-len(told) :]
        assert any(b"North" in payload for payload in broker.told("plant/events"))


async def test_what_is_not_sent_again_is_not_told_as_refused_for_ever(tmp_path: Path) -> None:
    """The answer to a command, and an alarm that has ended meanwhile."""
    result = "plant/trackers/T1/result"
    broker = FakeBroker(puback=lambda topic, payload: 0x87 if topic == result else 0)
    async with telling(tmp_path, broker, mqtt_commands=True) as (_, gateways, _):
        broker.publish(b"plant/trackers/T1/command", b'{"type":"stop","client":"a"}')
        await until(gateways, lambda metrics: result in metrics.error)
        await until(gateways, lambda metrics: not metrics.error)
        assert broker.connected == 1


async def test_a_farewell_that_no_broker_took_leaves_the_gateway_able_to_connect_again() -> None:
    client = broker_client(
        Settings(mqtt_host="127.0.0.1"), VirtualClock(NOON), "plant/availability", ProtocolVersion.V5
    )
    client.timeout = 0.0
    with pytest.raises(MqttError, match="timed out"):
        await client._wait_for(client._disconnected, timeout=None)
    client.close()


async def test_a_refused_subscription_is_tried_again(tmp_path: Path) -> None:
    broker = FakeBroker(suback=0x97)
    async with telling(tmp_path, broker, mqtt_commands=True) as (_, gateways, _):
        seen = await until(gateways, lambda metrics: "quota" in metrics.error)
        assert seen.error.startswith("No commands are received over MQTT.")
        broker.suback = 1
        seen = await until(gateways, lambda metrics: not metrics.error)
        assert seen.status is GatewayStatus.CONNECTED
        assert broker.connected == 1


async def test_a_refused_alarm_and_announcement_are_told_again_without_the_others(tmp_path: Path) -> None:
    denied = {"homeassistant/sensor/plant_T1/activity/config"}
    broker = FakeBroker(puback=lambda topic, payload: 0x87 if topic in denied else 0)
    async with telling(tmp_path, broker, mqtt_discovery=True) as (plant, gateways, _):
        await plant.forward(seconds=1)
        await until(gateways, lambda metrics: "sensor/plant_T1/activity" in metrics.error)
        denied.clear()
        await until(gateways, lambda metrics: not metrics.error)
        topics = [topic for topic, _ in broker.accepted if topic.startswith("homeassistant/")]
        assert len(topics) == len(set(topics)) == 5


async def test_two_controllers_with_one_id_are_told_so_and_take_turns_ever_more_seldom(
    tmp_path: Path,
) -> None:
    broker = FakeBroker()
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    async with (
        serving(broker),
        kept_plant(tmp_path / "one") as (first, store_one),
        kept_plant(tmp_path / "two") as (second, store_two),
    ):
        with capture_logs() as lines:
            async with (
                opened(first, mqtt_settings(tmp_path / "one", broker.port), store_one),
                opened(second, mqtt_settings(tmp_path / "two", broker.port), store_two),
            ):
                await eventually(lambda: broker.connected >= 8)
    ended = [line for line in lines if line.get("code") == 0x8E]
    assert {line["told"] for line in ended} == {
        "Another client uses the ID heliopanel at this broker. Choose another ID for this controller: set "
        "HELIOPANEL_MQTT_CLIENT_ID, and restart Heliopanel."
    }
    pauses = [line["again_s"] for line in ended]
    assert pauses[0] == 1.0
    assert max(pauses) >= 4.0
    assert all(later >= earlier for earlier, later in itertools.pairwise(pauses))


@pytest.mark.parametrize(
    ("delay", "lasted", "longest", "expected"),
    [
        (timedelta(), timedelta(seconds=1), LONGEST_DELAY, FIRST_DELAY),
        (timedelta(seconds=30), timedelta(seconds=60), LONGEST_DELAY, LONGEST_DELAY),
        (timedelta(seconds=30), timedelta(seconds=61), LONGEST_DELAY, FIRST_DELAY),
        (timedelta(minutes=5), timedelta(minutes=10), LONGEST_WHEN_TAKEN_OVER, timedelta(minutes=5)),
        (timedelta(minutes=5), timedelta(minutes=11), LONGEST_WHEN_TAKEN_OVER, FIRST_DELAY),
    ],
)
def test_the_pause_is_the_first_again_only_after_a_connection_that_lasted(
    delay: timedelta, lasted: timedelta, longest: timedelta, expected: timedelta
) -> None:
    assert next_delay(delay, lasted, longest) == expected


async def test_a_broker_of_mqtt_3_that_ends_every_connection_is_told_with_the_likely_cause(
    tmp_path: Path,
) -> None:
    broker = FakeBroker(knows_mqtt_5=False)
    async with telling(tmp_path, broker) as (_, gateways, _):
        for _ in range(CUT_OFF_OFTEN):
            await eventually(lambda: broker.told("plant/availability"))
            broker.accepted.clear()
            broker.session.farewell(0)
        seen = await until(gateways, lambda metrics: "ends every connection soon" in metrics.error)
        assert "another client uses the ID heliopanel" in seen.error


async def test_a_broker_of_mqtt_3_is_told_everything_and_asked_for_commands_once_it_learns_mqtt_5(
    tmp_path: Path,
) -> None:
    broker = FakeBroker(knows_mqtt_5=False)
    async with telling(tmp_path, broker, mqtt_commands=True) as (plant, gateways, _):
        seen = await until(gateways, is_connected)
        assert "does not speak MQTT 5" in seen.error
        await _event_arrives(plant, broker)
        assert broker.subscribed == 0, "no commands are taken"
        broker.knows_mqtt_5 = True
        broker.session.farewell(0)
        await until(gateways, lambda metrics: is_connected(metrics) and not metrics.error)
        assert broker.subscribed == 1


ODD = {
    "an acknowledgement of nothing": b"\x40\x02\xff\xff",
    "a reason that is none": b"\x40\x03\xff\xff\x7f",
    "a grant of nothing": b"\x90\x04\xff\xff\x00\x01",
    "a second welcome": b"\x20\x03\x00\x00\x00",
    "an end without a reason": b"\xe0\x00",
    "an end with a reason that is none": b"\xe0\x02\x7f\x00",
    "a question about the password": b"\xf0\x00",
    "a kind that is reserved": b"\x00\x00",
    "a length without an end": b"\x30\xff\xff\xff\xff\xff",
    "a ping of the wrong side": b"\xc0\x00",
}


async def test_a_packet_that_no_broker_should_send_costs_no_event(tmp_path: Path) -> None:
    broker = FakeBroker()
    async with telling(tmp_path, broker) as (plant, gateways, store):
        for why, packet in ODD.items():
            broker.session.writer.write(packet)
            await _event_arrives(plant, broker, f"After {why}")
            await until(gateways, is_connected)
            assert len(broker.sessions) == 1, why
        told = in_events(broker)
        assert told == in_journal(store)[-len(told) :]


async def test_a_connection_that_the_broker_did_not_answer_is_closed(tmp_path: Path) -> None:
    broker = FakeBroker(is_silent=True)
    async with telling(tmp_path, broker) as (plant, gateways, _):
        broker.is_silent = False
        await until(gateways, is_connected)
        await eventually(lambda: all(one.writer.is_closing() for one in broker.unanswered))
        await _event_arrives(plant, broker)
