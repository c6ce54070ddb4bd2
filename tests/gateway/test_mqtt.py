"""MQTT against a real Mosquitto: what is told, what is kept while it is down, and what it may ask."""

import asyncio
import contextlib
import gc
import json
import shutil
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from aiomqtt import Client, MqttError
from pydantic import SecretStr

from app.alarms.conditions import Condition
from app.base.settings import Settings
from app.gateway.gateways import Gateways
from app.gateway.mqtt import heeding
from app.link.alarm_orders import AcknowledgeAlarm
from app.link.messages import RenameSite
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.store.store import JournalEntry, JournalFilter, Writer
from app.tracker.commands.commands import Move
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.fault_result import FaultResult
from tests.gateway.rigs import gateway, kept_plant, opened
from tests.patience import LOOK_EVERY_S, PATIENCE_S, eventually, pause
from tests.ports import free_port
from tests.site.plant import SAMSUN

MOSQUITTO = shutil.which("mosquitto") or "/usr/sbin/mosquitto"


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
        for _ in range(int(PATIENCE_S / LOOK_EVERY_S)):
            with contextlib.suppress(OSError):
                _, writer = await asyncio.open_connection("127.0.0.1", self.port)
                writer.close()
                await writer.wait_closed()
                break
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
        self.listening = asyncio.create_task(self._listen(subscribed))
        await subscribed.wait()

    async def _listen(self, subscribed: asyncio.Event) -> None:
        with contextlib.suppress(MqttError):
            async with Client("127.0.0.1", self.port) as client:
                await client.subscribe("#", 1)
                subscribed.set()
                async for message in client.messages:
                    assert isinstance(message.payload, bytes)
                    self.heard.append((message.topic.value, message.payload, message.retain))

    async def send(self, topic: str, told: dict[str, Any], *, retain: bool = False) -> None:
        async with Client("127.0.0.1", self.port) as client:
            await client.publish(topic, json.dumps(told), 1, retain=retain)

    def told(self, topic: str) -> list[Any]:
        return [json.loads(payload) for name, payload, _ in self.heard if name == topic]

    def sentences(self) -> list[str]:
        return [event["message"] for event in self.told("plant/north/events")]


@asynccontextmanager
async def running(folder: Path, *lines: str) -> AsyncIterator[Broker]:
    broker = Broker(folder, lines=lines)
    await broker.start()
    await broker.listen()
    try:
        yield broker
    finally:
        if broker.listening is not None:
            broker.listening.cancel()
        await broker.kill()


@pytest.fixture
async def broker(tmp_path: Path) -> AsyncIterator[Broker]:
    async with running(tmp_path) as found:
        yield found


def settings(tmp_path: Path, broker: Broker, **more: Any) -> Settings:
    return Settings(
        data_dir=tmp_path, mqtt_host="127.0.0.1", mqtt_port=broker.port, mqtt_base_topic="plant/north", **more
    )


async def test_snapshots_are_told_as_one_message_a_tracker(tmp_path: Path, broker: Broker) -> None:
    async with (
        kept_plant(tmp_path, "T1", "T2") as (plant, store),
        opened(plant, settings(tmp_path, broker), store),
    ):
        await plant.commission()
        await plant.forward(seconds=1)
        topic = "plant/north/trackers/T1/snapshot"
        await eventually(lambda: any(one["homed"] for one in broker.told(topic)))
        newest = broker.told(topic)[-1]
        assert newest["measured_azimuth_deg"] == pytest.approx(plant.tracker().measured.azimuth_deg)  # type: ignore[union-attr]
        assert newest["activity"] == "holding"
        assert broker.told("plant/north/trackers/T2/snapshot")[-1]["homed"] is False
        site = broker.told("plant/north/site")[-1]
        assert site["location"]["latitude_deg"] == SAMSUN.latitude_deg
        assert site["trackers"] == ["T1", "T2"]
        assert ("plant/north/availability", b"online", False) in broker.heard


async def test_snapshots_are_told_as_columns(tmp_path: Path, broker: Broker) -> None:
    wanted = settings(tmp_path, broker, mqtt_payload="columns")
    async with kept_plant(tmp_path, "T1", "T2", "T3") as (plant, store), opened(plant, wanted, store):
        await plant.forward(seconds=0.2)
        await eventually(lambda: broker.told("plant/north/columns"))
        columns = broker.told("plant/north/columns")[-1]["columns"]
        assert columns["tracker_id"] == ["T1", "T2", "T3"]
        assert {len(column) for column in columns.values()} == {3}
        assert not broker.told("plant/north/trackers/T1/snapshot")


async def test_a_killed_broker_loses_no_event_and_the_site_does_not_wait(
    tmp_path: Path, broker: Broker
) -> None:
    async with (
        kept_plant(tmp_path) as (plant, store),
        opened(plant, settings(tmp_path, broker), store) as gateways,
    ):
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        await plant.commission()
        await eventually(lambda: any("location was set" in one for one in broker.sentences()))
        await broker.kill()
        before = plant.tracker().tick
        for number in range(120):
            await plant.ask(RenameSite(f"Field {number}"))
        await plant.forward(seconds=1)
        assert plant.tracker().tick > before, "the site ticks on while the broker is away"
        lost = await _until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTING)
        assert "retries automatically" in lost.error
        await broker.start()
        await broker.listen()
        await eventually(lambda: any("Field 119" in one for one in broker.sentences()))
        await _until(gateways, lambda seen: seen.waiting == 0)
        told = _all_once(broker.told("plant/north/events"))
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
    wanted = settings(tmp_path, broker)
    async with kept_plant(tmp_path) as (plant, store):
        async with opened(plant, wanted, store):
            await eventually(lambda: broker.told("plant/north/site"))
        await eventually(lambda: ("plant/north/availability", b"offline", False) in broker.heard)
        await plant.ask(RenameSite("Unheard"))
        async with opened(plant, wanted, store):
            await eventually(lambda: any("Unheard" in one for one in broker.sentences()))


async def test_the_last_will_says_that_a_lost_machine_is_offline(tmp_path: Path, broker: Broker) -> None:
    relay = await asyncio.start_server(lambda r, w: _relay(r, w, broker.port), "127.0.0.1", 0)
    port = relay.sockets[0].getsockname()[1]
    wanted = settings(tmp_path, broker).model_copy(update={"mqtt_port": port})
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        relay.close()
        for writer in RELAYED:
            writer.transport.abort()
        await eventually(lambda: ("plant/north/availability", b"offline", False) in broker.heard)


async def test_recordings_are_announced_when_they_begin_and_end(tmp_path: Path, broker: Broker) -> None:
    async with kept_plant(tmp_path) as (plant, store), opened(plant, settings(tmp_path, broker), store):
        await plant.commission()
        await plant.forward(seconds=1)
        await eventually(lambda: broker.told("plant/north/recordings"))
        assert broker.told("plant/north/recordings")[0]["state"] == "running"
        plant.site.model.recorder.finish("T1", plant.site.model.now(), "ended by the test")
        await plant.forward(seconds=1)
        await eventually(lambda: "ended by the test" in outcomes(broker))
        assert outcomes(broker)["ended by the test"] == "finished"


def outcomes(broker: Broker) -> dict[str, str]:
    """Return the states of the recordings that were told, by outcome."""
    return {one["outcome"]: one["state"] for one in broker.told("plant/north/recordings")}


async def test_commands_go_through_the_same_door_when_they_are_allowed(
    tmp_path: Path, broker: Broker
) -> None:
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        result = "plant/north/trackers/T1/result"
        move = {"type": "move", "azimuth_deg": 90, "elevation_deg": 40, "client": "scada", "key": "m-1"}
        await broker.send("plant/north/trackers/T1/command", move)
        await eventually(lambda: broker.told(result))
        assert broker.told(result) == [{"key": "m-1", "accepted": True, "reasons": []}]
        assert plant.tracker().activity is ActivityName.MOVING
        await broker.send("plant/north/trackers/T1/command", {"type": "home", "client": "scada"})
        await eventually(lambda: len(broker.told(result)) == 2)
        assert broker.told(result)[1]["reasons"][0]["code"] == "busy_moving"
        await broker.send("plant/north/trackers/T1/command", {"type": "fly", "client": "scada"})
        await eventually(lambda: len(broker.told(result)) == 3)
        assert broker.told(result)[2]["reasons"][0]["code"] == "malformed"
        await broker.send("plant/north/trackers/T1/command", {"type": "stop", "client": "scada"}, retain=True)
        await eventually(lambda: len(broker.told(result)) == 4)
        journal = [(entry.event.actor, entry.event.message) for entry in _journal(store)]
        assert ("mqtt scada", "Going to azimuth 90.0, elevation 40.0 degrees.") in journal
        assert any(actor == "mqtt scada" and "was refused" in message for actor, message in journal)


@pytest.mark.parametrize("more", [{}, {"client": 7}, {"client": "scada", "urgent": True}])
async def test_a_stop_stops_whatever_else_the_message_says(
    tmp_path: Path, broker: Broker, more: dict[str, Any]
) -> None:
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await plant.ask(Move(Orientation(200.0, 40.0)))
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        await broker.send("plant/north/trackers/T1/command", {"type": "stop", **more})
        await eventually(lambda: broker.told("plant/north/trackers/T1/result"))
        assert broker.told("plant/north/trackers/T1/result")[0]["accepted"] is True
        assert plant.happened(EventKind.STOPPED)[-1].actor == "mqtt unnamed"
        await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)


COMMAND, RESULT = "plant/north/trackers/T1/command", "plant/north/trackers/T1/result"


def command(kind: str, key: str, **values: object) -> dict[str, object]:
    return {"type": kind, "client": "scada", "key": key, **values}


async def test_a_command_that_was_retained_before_is_not_even_heard(tmp_path: Path, broker: Broker) -> None:
    for tracker_id, kind in (("T1", "home"), ("T2", "stop")):
        topic = f"plant/north/trackers/{tracker_id}/command"
        await broker.send(topic, command(kind, "before"), retain=True)
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    async with kept_plant(tmp_path, "T1", "T2") as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        await broker.send(COMMAND, command("move", "now", azimuth_deg=90, elevation_deg=40))
        await eventually(lambda: broker.told(RESULT))
        assert [one["key"] for one in broker.told(RESULT)] == ["now"]
        assert not broker.told("plant/north/trackers/T2/result")
        assert not plant.happened(EventKind.STOPPED)


async def test_a_retained_command_is_refused_while_connected_but_not_a_stop(
    tmp_path: Path, broker: Broker
) -> None:
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
        move = command("move", "m", azimuth_deg=90, elevation_deg=40)
        await broker.send(COMMAND, move, retain=True)
        await eventually(lambda: broker.told(RESULT))
        assert broker.told(RESULT)[0]["reasons"][0]["code"] == "retained"
        assert plant.tracker().activity is ActivityName.HOLDING
        await broker.send(COMMAND, command("stop", "s"), retain=True)
        await eventually(lambda: len(broker.told(RESULT)) == 2)
        assert broker.told(RESULT)[1] == {"key": "s", "accepted": True, "reasons": []}


@pytest.mark.fault(90)
async def test_a_command_of_the_future_is_refused_but_not_a_stop(
    tmp_path: Path, broker: Broker, fault: FaultResult
) -> None:
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.commission()
        await eventually(lambda: ("plant/north/availability", b"online", False) in broker.heard)
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


async def test_an_older_broker_is_told_everything_and_no_commands_are_taken(
    tmp_path: Path, broker: Broker
) -> None:
    older = await asyncio.start_server(lambda r, w: _older(r, w, broker.port), "127.0.0.1", 0)
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    wanted = wanted.model_copy(update={"mqtt_port": older.sockets[0].getsockname()[1]})
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store) as gateways:
        await plant.commission()
        seen = await _until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTED)
        assert "does not speak MQTT 5" in seen.error
        await broker.send(COMMAND, command("move", "m", azimuth_deg=90, elevation_deg=40))
        sites = len(broker.told("plant/north/site"))
        await eventually(lambda: len(broker.told("plant/north/site")) > sites + 3)
        assert plant.tracker().activity is ActivityName.HOLDING
        assert not broker.told(RESULT)
    older.close()
    await older.wait_closed()


async def test_a_broker_that_learns_mqtt_5_is_asked_for_commands_at_the_next_connection(
    tmp_path: Path, broker: Broker
) -> None:
    talking: list[asyncio.Task[None]] = []
    old = asyncio.Event()
    old.set()

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        work = _older if old.is_set() else _through
        talking.append(asyncio.create_task(work(reader, writer, broker.port)))

    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    wanted = settings(tmp_path, broker, mqtt_commands=True)
    wanted = wanted.model_copy(update={"mqtt_port": server.sockets[0].getsockname()[1]})
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store) as gateways:
        await _until(gateways, lambda seen: "does not speak MQTT 5" in seen.error)
        old.clear()
        for task in talking:
            task.cancel()
        seen = await _until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTED and not seen.error)
        assert seen.error == ""
    server.close()
    for task in talking:
        task.cancel()
    await asyncio.gather(*talking, return_exceptions=True)


async def _through(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, port: int) -> None:
    with contextlib.closing(writer):
        behind, to_broker = await asyncio.open_connection("127.0.0.1", port)
        with contextlib.closing(to_broker):
            await asyncio.gather(_pass_on(reader, to_broker), _pass_on(behind, writer))


async def _older(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, port: int) -> None:
    """A broker that knows MQTT 3.1.1: it refuses version 5 as that version's document says."""
    with contextlib.closing(writer):
        connect = await reader.read(4096)
        if connect[connect.index(b"MQTT") + 4] == 5:
            writer.write(bytes((0x20, 2, 0, 1)))
            await writer.drain()
            return
        behind, to_broker = await asyncio.open_connection("127.0.0.1", port)
        to_broker.write(connect)
        with contextlib.closing(to_broker):
            await asyncio.gather(_pass_on(reader, to_broker), _pass_on(behind, writer))


async def _pass_on(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with contextlib.suppress(OSError):
        while data := await reader.read(65536):
            writer.write(data)
    writer.close()


async def test_commands_are_not_heard_unless_they_are_allowed(tmp_path: Path, broker: Broker) -> None:
    async with kept_plant(tmp_path) as (plant, store), opened(plant, settings(tmp_path, broker), store):
        await plant.commission()
        await broker.send("plant/north/trackers/T1/command", {"type": "home", "client": "scada"})
        sites = len(broker.told("plant/north/site"))
        await eventually(lambda: len(broker.told("plant/north/site")) > sites + 3)
        assert plant.tracker().activity is ActivityName.HOLDING
        assert not broker.told("plant/north/trackers/T1/result")


@pytest.mark.parametrize("commands", [False, True])
async def test_home_assistant_finds_sensors_and_buttons_only_if_commands_are_allowed(
    tmp_path: Path, broker: Broker, commands: bool
) -> None:
    wanted = settings(tmp_path, broker, mqtt_discovery=True, mqtt_commands=commands)
    async with kept_plant(tmp_path) as (plant, store), opened(plant, wanted, store):
        await plant.forward(seconds=0.2)
        await eventually(lambda: broker.told("plant/north/site"))
        found = {
            name: json.loads(told) for name, told, _ in broker.heard if name.startswith("homeassistant/")
        }
        azimuth = found["homeassistant/sensor/plant_north_T1/measured_azimuth_deg/config"]
        assert azimuth["state_topic"] == "plant/north/trackers/T1/snapshot"
        assert azimuth["availability_topic"] == "plant/north/availability"
        buttons = {name for name in found if name.startswith("homeassistant/button/")}
        assert len(buttons) == (3 if commands else 0)
        if commands:
            press = found["homeassistant/button/plant_north_T1/stop/config"]
            await broker.send(press["command_topic"], json.loads(press["payload_press"]))
            await eventually(lambda: broker.told("plant/north/trackers/T1/result"))
            assert broker.told("plant/north/trackers/T1/result")[0]["accepted"] is True


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
    await _run("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
               "-nodes", "-keyout", str(key), "-out", str(certificate), "-subj", "/CN=127.0.0.1",
               "-addext", "subjectAltName=IP:127.0.0.1")  # fmt: skip
    await _run("mosquitto_passwd", "-b", "-c", str(passwords), "heliopanel", "open sesame")
    broker = Broker(tmp_path, lines=(
        f"listener {(tls_port := free_port())} 127.0.0.1", f"certfile {certificate}", f"keyfile {key}",
        "allow_anonymous false", f"password_file {passwords}", "user root",
    ))  # fmt: skip
    await broker.start()
    async with kept_plant(tmp_path) as (plant, store):
        wanted = settings(
            tmp_path, broker, mqtt_tls=True, mqtt_ca_file=certificate, mqtt_username="heliopanel"
        )
        wanted = wanted.model_copy(update={"mqtt_port": tls_port})
        async with opened(plant, wanted, store) as gateways:
            await _until(gateways, lambda seen: "does not authorize this controller" in seen.error)
        right = wanted.model_copy(update={"mqtt_password": SecretStr("open sesame")})
        async with opened(plant, right, store) as gateways:
            await _until(gateways, lambda seen: seen.status is GatewayStatus.CONNECTED)
        strange = right.model_copy(update={"mqtt_ca_file": None})
        async with opened(plant, strange, store) as gateways:
            await _until(gateways, lambda seen: "certificate" in seen.error)
    await broker.kill()


async def _run(*words: str) -> None:
    process = await asyncio.create_subprocess_exec(*words, stderr=asyncio.subprocess.DEVNULL)
    assert await process.wait() == 0, words


RELAYED: list[asyncio.StreamWriter] = []


async def _relay(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, port: int) -> None:
    """Pass bytes on both ways, so that a connection can be cut without a farewell."""
    RELAYED.append(writer)
    there, back = await asyncio.open_connection("127.0.0.1", port)
    RELAYED.append(back)

    async def pass_on(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            while data := await source.read(4096):
                sink.write(data)
        sink.transport.abort()

    await asyncio.gather(pass_on(reader, back), pass_on(there, writer))


def _journal(store: Writer) -> list[JournalEntry]:
    return store.journal(JournalFilter(after=0, limit=10_000))


def _all_once(told: list[Any]) -> list[int]:
    """Return the sequence numbers as a receiver keeps them: a repeat is dropped."""
    assert len({one["series"] for one in told}) == 1
    return list(dict.fromkeys(one["sequence"] for one in told))


async def _until(gateways: Gateways, found: Callable[[GatewayMetrics], bool]) -> GatewayMetrics:
    async with asyncio.timeout(PATIENCE_S):
        while not found(seen := await gateway(gateways, "MQTT")):
            await pause()
    return seen


async def test_alarms_are_retained_while_they_stand_and_taken_back(tmp_path: Path, broker: Broker) -> None:
    topic = "plant/north/alarms/clock_jumped"
    async with kept_plant(tmp_path) as (plant, store), opened(plant, settings(tmp_path, broker), store):
        plant.site.trouble("clock", Condition("clock_jumped", None, "Site", "It jumped."))
        await plant.forward(seconds=1)
        await eventually(lambda: any(name == topic for name, _, _ in broker.heard))
        told = broker.told(topic)[0]
        assert (told["priority"], told["state"], told["message"]) == (3, "unacknowledged", "It jumped.")
        plant.site.trouble("clock", None)
        await plant.ask(AcknowledgeAlarm("clock_jumped"))
        await plant.forward(seconds=11)
        await eventually(lambda: (topic, b"") in [(name, payload) for name, payload, _ in broker.heard])
