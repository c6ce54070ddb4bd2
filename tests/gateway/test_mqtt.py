"""MQTT against a real Mosquitto: what is told, what is kept while it is down, and what it may ask."""

import asyncio
import contextlib
import gc
import json
import shutil
import socket
from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from aiomqtt import Client, MqttError
from pydantic import SecretStr

from app.alarms.conditions import Condition
from app.gateway.mqtt import heeding
from app.link.alarm_orders import AcknowledgeAlarm
from app.link.messages import RenameSite
from app.link.metrics import GatewayStatus
from app.store.store import JournalEntry, JournalFilter, Writer
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.fault_result import FaultResult
from tests.gateway.rigs import kept_plant, mqtt_settings, opened, until
from tests.patience import PATIENCE_S, eventually, pause
from tests.peers.processes import output
from tests.ports import free_port
from tests.site.plant import SAMSUN

MOSQUITTO = shutil.which("mosquitto") or "/usr/sbin/mosquitto"


def is_listening(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@dataclass
class Broker:
    """A Mosquitto on a free port that can be killed and started again, and everything that it passed on."""

    folder: Path
    port: int = field(default_factory=free_port)
    lines: tuple[str, ...] = ()
    process: asyncio.subprocess.Process | None = None
    heard: list[tuple[str, bytes, bool]] = field(default_factory=list)
    listening: asyncio.Task[None] | None = None

    async def start(self) -> None:
        assert shutil.which(MOSQUITTO), "The tests need mosquitto. Install it with: make system-packages"
        config = self.folder / "mosquitto.conf"
        config.write_text("\n".join((f"listener {self.port} 127.0.0.1", "allow_anonymous true", *self.lines)))
        self.process = await asyncio.create_subprocess_exec(
            MOSQUITTO, "-c", str(config), stderr=asyncio.subprocess.DEVNULL
        )
        async with asyncio.timeout(PATIENCE_S):
            while not is_listening(self.port):
                await pause()

    async def kill(self) -> None:
        assert self.process is not None
        self.process.kill()
        await self.process.wait()
        if self.listening is not None:
            await asyncio.gather(self.listening, return_exceptions=True)

    async def listen(self) -> None:
        """Keep every message from now on; the subscription stands when this returns."""
        subscribed = asyncio.Event()

        async def hear() -> None:
            with contextlib.suppress(MqttError):
                async with Client("127.0.0.1", self.port) as client:
                    await client.subscribe("#", 1)
                    subscribed.set()
                    async for message in client.messages:
                        assert isinstance(message.payload, bytes)
                        self.heard.append((message.topic.value, message.payload, message.retain))

        self.listening = asyncio.create_task(hear())
        await subscribed.wait()

    async def send(self, topic: str, told: dict[str, Any], *, retain: bool = False) -> None:
        async with Client("127.0.0.1", self.port) as client:
            await client.publish(topic, json.dumps(told), 1, retain=retain)

    def told(self, topic: str) -> list[Any]:
        return [json.loads(payload) for name, payload, _ in self.heard if name == topic]

    async def is_told(self, availability: bytes) -> None:
        """Wait until the controller is said to be online or offline."""
        wanted = ("plant/availability", availability, False)
        await eventually(lambda: wanted in self.heard)

    def sentences(self) -> list[str]:
        return [event["message"] for event in self.told("plant/events")]


@pytest.fixture
async def broker(tmp_path: Path) -> AsyncIterator[Broker]:
    found = Broker(tmp_path)
    await found.start()
    await found.listen()
    yield found
    if found.listening is not None:
        found.listening.cancel()
    await found.kill()


async def test_snapshots_are_told_as_one_message_a_tracker(tmp_path: Path, broker: Broker) -> None:
    async with (
        kept_plant(tmp_path, "T1", "T2") as (plant, store),
        opened(plant, mqtt_settings(tmp_path, broker.port), store),
    ):
        await plant.commission()
        await plant.forward(seconds=1)
        topic = "plant/trackers/T1/snapshot"
        await eventually(lambda: any(one["homed"] for one in broker.told(topic)))
        newest = broker.told(topic)[-1]
        assert newest["measured_azimuth_deg"] == pytest.approx(plant.tracker().measured.azimuth_deg)  # type: ignore[union-attr]
        assert newest["activity"] == "holding"
        assert broker.told("plant/trackers/T2/snapshot")[-1]["homed"] is False
        site = broker.told("plant/site")[-1]
        assert site["location"]["latitude_deg"] == SAMSUN.latitude_deg
        assert site["trackers"] == ["T1", "T2"]
        assert ("plant/availability", b"online", False) in broker.heard


async def test_snapshots_are_told_as_columns(tmp_path: Path, broker: Broker) -> None:
    wanted = mqtt_settings(tmp_path, broker.port, mqtt_payload="columns")
    async with kept_plant(tmp_path, "T1", "T2") as (plant, store), opened(plant, wanted, store):
        await plant.forward(seconds=0.2)
        await eventually(lambda: broker.told("plant/columns"))
        columns = broker.told("plant/columns")[-1]["columns"]
        assert columns["tracker_id"] == ["T1", "T2"]
        assert {len(column) for column in columns.values()} == {2}
        assert not broker.told("plant/trackers/T1/snapshot")


async def test_a_killed_broker_loses_no_event_and_the_site_does_not_wait(
    tmp_path: Path, broker: Broker
) -> None:
    async with (
        kept_plant(tmp_path) as (plant, store),
        opened(plant, mqtt_settings(tmp_path, broker.port), store) as gateways,
    ):
        await broker.is_told(b"online")
        await plant.commission()
        await eventually(lambda: any("location was set" in one for one in broker.sentences()))
        await broker.kill()
        before = plant.tracker().tick
        for number in range(120):
            await plant.ask(RenameSite(f"Field {number}"))
        await plant.forward(seconds=1)
        assert plant.tracker().tick > before, "the site ticks on while the broker is away"
        lost = await until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTING)
        assert "retries automatically" in lost.error
        await broker.start()
        await broker.listen()
        await eventually(lambda: any("Field 119" in one for one in broker.sentences()))
        await until(gateways, lambda seen: seen.waiting == 0)
        events = broker.told("plant/events")
        assert len({one["series"] for one in events}) == 1
        told = list(dict.fromkeys(one["sequence"] for one in events))
        assert told == [entry.number for entry in _journal(store)][-len(told) :], "none is missing in between"
        assert len(told) > 120


async def test_a_cancellation_that_comes_with_the_brokers_answer_is_heeded() -> None:
    answer: asyncio.Future[str] = asyncio.get_running_loop().create_future()
    telling = asyncio.create_task(heeding(asyncio.wait_for(answer, PATIENCE_S)))
    await asyncio.sleep(0)
    answer.set_result("acknowledged")
    await asyncio.sleep(0)
    telling.cancel()
    with pytest.raises(asyncio.CancelledError):
        await telling


async def test_a_restarted_machine_tells_what_it_had_not(tmp_path: Path, broker: Broker) -> None:
    wanted = mqtt_settings(tmp_path, broker.port)
    async with kept_plant(tmp_path) as (plant, store):
        async with opened(plant, wanted, store):
            await eventually(lambda: broker.told("plant/site"))
        await broker.is_told(b"offline")
        await plant.ask(RenameSite("Unheard"))
        async with opened(plant, wanted, store):
            await eventually(lambda: any("Unheard" in one for one in broker.sentences()))


async def test_the_last_will_says_that_a_lost_machine_is_offline(tmp_path: Path, broker: Broker) -> None:
    relayed: list[asyncio.StreamWriter] = []

    async def pass_on(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            while data := await source.read(4096):
                sink.write(data)
        sink.transport.abort()

    async def relay(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        there, back = await asyncio.open_connection("127.0.0.1", broker.port)
        relayed.extend((writer, back))
        await asyncio.gather(pass_on(reader, back), pass_on(there, writer))

    server = await asyncio.start_server(relay, "127.0.0.1", 0)
    wanted = mqtt_settings(tmp_path, server.sockets[0].getsockname()[1])
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await broker.is_told(b"online")
        server.close()
        for writer in relayed:
            writer.transport.abort()
        await broker.is_told(b"offline")


async def test_recordings_are_announced_when_they_begin_and_end(tmp_path: Path, broker: Broker) -> None:
    async with (
        kept_plant(tmp_path) as (plant, store),
        opened(plant, mqtt_settings(tmp_path, broker.port), store),
    ):
        await plant.commission()
        await plant.forward(seconds=1)
        await eventually(lambda: broker.told("plant/recordings"))
        assert broker.told("plant/recordings")[0]["state"] == "running"
        plant.site.model.recorder.finish("T1", plant.site.model.now(), "ended by the test")
        await plant.forward(seconds=1)
        ended = ("ended by the test", "finished")
        await eventually(
            lambda: ended in [(one["outcome"], one["state"]) for one in broker.told("plant/recordings")]
        )


COMMAND, RESULT = "plant/trackers/T1/command", "plant/trackers/T1/result"


def command(kind: str, key: str, **values: object) -> dict[str, object]:
    return {"type": kind, "client": "scada", "key": key, **values}


def by_scada(store: Writer) -> list[str]:
    return [entry.event.message for entry in _journal(store) if entry.event.actor == "mqtt scada"]


async def test_commands_go_through_the_same_door_when_they_are_allowed(
    tmp_path: Path, broker: Broker
) -> None:
    wanted = mqtt_settings(tmp_path, broker.port, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await broker.is_told(b"online")
        await broker.send(COMMAND, command("move", "m-1", azimuth_deg=90, elevation_deg=40))
        await eventually(lambda: broker.told(RESULT))
        assert broker.told(RESULT) == [{"key": "m-1", "accepted": True, "reasons": []}]
        assert plant.tracker().activity is ActivityName.MOVING
        for number, (kind, code) in enumerate((("home", "busy_moving"), ("fly", "malformed")), 2):
            await broker.send(COMMAND, command(kind, kind))
            await eventually(lambda number=number: len(broker.told(RESULT)) == number)  # type: ignore[misc]
            assert broker.told(RESULT)[-1]["reasons"][0]["code"] == code
        await plant.forward(seconds=1)
        await eventually(lambda: any("was refused" in one for one in by_scada(store)))
        assert "Going to azimuth 90.0, elevation 40.0 degrees." in by_scada(store)


async def test_a_command_that_was_retained_before_is_not_even_heard(tmp_path: Path, broker: Broker) -> None:
    for tracker_id, kind in (("T1", "home"), ("T2", "stop")):
        topic = f"plant/trackers/{tracker_id}/command"
        await broker.send(topic, command(kind, "before"), retain=True)
    wanted = mqtt_settings(tmp_path, broker.port, mqtt_commands=True)
    async with kept_plant(tmp_path, "T1", "T2") as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await broker.is_told(b"online")
        await broker.send(COMMAND, command("move", "now", azimuth_deg=90, elevation_deg=40))
        await eventually(lambda: broker.told(RESULT))
        assert [one["key"] for one in broker.told(RESULT)] == ["now"]
        assert not broker.told("plant/trackers/T2/result")
        assert not plant.happened(EventKind.STOPPED)


@pytest.mark.fault(90)
async def test_a_command_of_the_future_is_refused_but_not_a_stop(
    tmp_path: Path, broker: Broker, fault: FaultResult
) -> None:
    wanted = mqtt_settings(tmp_path, broker.port, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await broker.is_told(b"online")
        told = broker.told
        ahead = (plant.clock.now() + timedelta(hours=1)).isoformat()
        there = {"azimuth_deg": 90, "elevation_deg": 40}
        await broker.send(COMMAND, command("move", "m", issued_at=ahead, **there))
        await eventually(lambda: told(RESULT))
        assert told(RESULT)[0]["reasons"][0]["code"] == "from_the_future"
        assert plant.tracker().activity is ActivityName.HOLDING
        await broker.send(COMMAND, command("stop", "s", issued_at=ahead))
        await eventually(lambda: len(told(RESULT)) == 2)
        assert told(RESULT)[1] == {"key": "s", "accepted": True, "reasons": []}
        await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
        await broker.send(COMMAND, command("move", "n", issued_at=plant.clock.now().isoformat(), **there))
        await eventually(lambda: len(told(RESULT)) == 3)
        assert told(RESULT)[2] == {"key": "n", "accepted": True, "reasons": []}
        fault.prevented("it is refused")
        fault.recovers("the clock is set; the next command is obeyed")


async def test_home_assistant_finds_sensors_and_buttons_that_work(tmp_path: Path, broker: Broker) -> None:
    wanted = mqtt_settings(tmp_path, broker.port, mqtt_discovery=True, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.forward(seconds=0.2)
        await eventually(lambda: broker.told("plant/site"))
        found = {
            name: json.loads(told) for name, told, _ in broker.heard if name.startswith("homeassistant/")
        }
        azimuth = found["homeassistant/sensor/plant_T1/measured_azimuth_deg/config"]
        assert azimuth["state_topic"] == "plant/trackers/T1/snapshot"
        press = found["homeassistant/button/plant_T1/stop/config"]
        await broker.send(press["command_topic"], json.loads(press["payload_press"]))
        await eventually(lambda: broker.told(RESULT))
        assert broker.told(RESULT)[0]["accepted"] is True


@pytest.fixture
def collected() -> Iterator[None]:
    """Collect what a test leaves before the next one."""
    yield
    gc.collect()


# paho leaves a socket to the garbage collector when it does not trust the broker's certificate.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.usefixtures("collected")
async def test_tls_and_a_password_open_a_broker_that_wants_them(tmp_path: Path) -> None:
    certificate, key, passwords = tmp_path / "cert.pem", tmp_path / "key.pem", tmp_path / "passwords"
    await output("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
               "-nodes", "-keyout", str(key), "-out", str(certificate), "-subj", "/CN=127.0.0.1",
               "-addext", "subjectAltName=IP:127.0.0.1")  # fmt: skip
    await output("mosquitto_passwd", "-b", "-c", str(passwords), "heliopanel", "open sesame")
    broker = Broker(tmp_path, lines=(
        f"listener {(tls_port := free_port())} 127.0.0.1", f"certfile {certificate}", f"keyfile {key}",
        "allow_anonymous false", f"password_file {passwords}", "user root",
    ))  # fmt: skip
    await broker.start()
    async with kept_plant(tmp_path) as (plant, store):
        wanted = mqtt_settings(
            tmp_path, tls_port, mqtt_tls=True, mqtt_ca_file=certificate, mqtt_username="heliopanel"
        )
        async with opened(plant, wanted, store) as gateways:
            await until(gateways, lambda seen: "does not authorize this controller" in seen.error)
        right = wanted.model_copy(update={"mqtt_password": SecretStr("open sesame")})
        async with opened(plant, right, store) as gateways:
            await until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTED)
        strange = right.model_copy(update={"mqtt_ca_file": None})
        async with opened(plant, strange, store) as gateways:
            await until(gateways, lambda seen: "certificate" in seen.error)
    await broker.kill()


def _journal(store: Writer) -> list[JournalEntry]:
    return store.journal(JournalFilter(after=0, limit=10_000))


async def test_alarms_are_retained_while_they_stand_and_taken_back(tmp_path: Path, broker: Broker) -> None:
    topic = "plant/alarms/clock_jumped"
    async with (
        kept_plant(tmp_path) as (plant, store),
        opened(plant, mqtt_settings(tmp_path, broker.port), store),
    ):
        plant.site.trouble("clock", Condition("clock_jumped", None, "Site", "It jumped."))
        await plant.forward(seconds=1)
        await eventually(lambda: any(name == topic for name, _, _ in broker.heard))
        told = broker.told(topic)[0]
        assert (told["priority"], told["state"], told["message"]) == (3, "unacknowledged", "It jumped.")
        plant.site.trouble("clock", None)
        await plant.ask(AcknowledgeAlarm("clock_jumped"))
        await plant.forward(seconds=11)
        await eventually(lambda: (topic, b"") in [(name, payload) for name, payload, _ in broker.heard])
