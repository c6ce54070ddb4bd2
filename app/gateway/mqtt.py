"""The MQTT gateway: tells snapshots, events and recordings, and takes commands if it may.

The machine never waits for the broker: snapshots are taken from the newest one there is, events from the
journal on disk, and both by tasks of their own.
"""

import asyncio
import logging
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from contextlib import asynccontextmanager, suppress
from datetime import datetime, timedelta
from pathlib import Path
from typing import TypeVar

from aiomqtt import Client, MqttError, ProtocolVersion, TLSParameters, Will
from aiomqtt.exceptions import MqttConnectError
from paho.mqtt.subscribeoptions import SubscribeOptions

from app.alarms.conditions import SITE, Condition
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import NOTHING, Message, plain, say
from app.base.settings import Settings
from app.gateway.mqtt_discovery import announcements
from app.gateway.mqtt_lanes import CommandLanes
from app.gateway.mqtt_messages import (
    OFFLINE,
    ONLINE,
    Topics,
    alarm_payload,
    columns_payload,
    event_payload,
    recording_payload,
    site_payload,
    tracker_payload,
)
from app.gateway.outbox import Outbox
from app.gateway.ports import MQTT_NAME, Door
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.store.store import StoreFailed
from app.tracker.state.snapshot import SiteSnapshot

FIRST_DELAY, LONGEST_DELAY = timedelta(seconds=1), timedelta(seconds=30)
LOOK_FOR_EVENTS = timedelta(milliseconds=500)
LOOK_FOR_RECORDINGS = timedelta(seconds=5)
AT_ONCE = 50
ANSWER_WITHIN_S = 5.0
KEEPALIVE_S = 15
SAY_AGAIN = timedelta(minutes=1)
MOST_COMMANDS_WAITING = 100
AT_LEAST_ONCE = 1
HEARD = SubscribeOptions(
    qos=AT_LEAST_ONCE,
    retainAsPublished=True,
    retainHandling=SubscribeOptions.RETAIN_DO_NOT_SEND,
)
"""A command that was sent to be retained keeps its flag; what was retained before is not sent at all."""
UNSUPPORTED_VERSION = 132

T = TypeVar("T")

log = get_logger()


class MqttGateway:
    """Keeps one connection to a broker; while it is down, events wait on disk."""

    def __init__(self, door: Door, clock: Clock, settings: Settings, outbox: Outbox) -> None:
        self._door = door
        self._clock = clock
        self._settings = settings
        self._outbox = outbox
        self._topics = Topics(settings.mqtt_base_topic)
        self._every = timedelta(seconds=settings.mqtt_publish_interval_s)
        self._status = GatewayStatus.CONNECTING
        self._error = NOTHING
        self._waiting = 0
        self._announced: dict[str, bytes] = {}
        self._alarms: dict[str, bytes] | None = None
        self._protocol = ProtocolVersion.V5

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        connected = self._status is GatewayStatus.CONNECTED
        return GatewayMetrics(
            MQTT_NAME, self._status, plain(self._where), int(connected), self._error, self._waiting
        )

    @property
    def _port(self) -> int:
        return self._settings.mqtt_port or (8883 if self._settings.mqtt_tls else 1883)

    @property
    def _where(self) -> str:
        return f"{self._settings.mqtt_host}:{self._port}"

    @property
    def _deaf(self) -> Message:
        """Return why no commands are heard although they are allowed, empty if they are."""
        if self._protocol is ProtocolVersion.V5 or not self._settings.mqtt_commands:
            return NOTHING
        return say(
            "The broker at {where} does not speak MQTT 5, so no commands are accepted.", where=self._where
        )

    async def run(self) -> None:
        """Connect, tell, and connect again, until cancelled."""
        delay = FIRST_DELAY
        while True:
            try:
                await asyncio.to_thread(self._outbox.begin)
                async with self._connected() as client:
                    delay = FIRST_DELAY
                    await self._tell(client)
            except* (MqttError, StoreFailed, OSError) as errors:
                self._note_failure(errors)
            await self._count_waiting()
            await self._clock.sleep_until(self._clock.now() + delay)
            delay = min(2 * delay, LONGEST_DELAY)

    def _note_failure(self, errors: ExceptionGroup[Exception]) -> None:
        first: BaseException = errors
        while isinstance(first, BaseExceptionGroup):
            first = first.exceptions[0]
        self._status = GatewayStatus.CONNECTING
        self._protocol = ProtocolVersion.V5
        if isinstance(first, MqttConnectError) and first.rc == UNSUPPORTED_VERSION:
            self._protocol = ProtocolVersion.V311
            log.warning("mqtt_older_broker", broker=self._where, commands="none are taken")
        self._error = say(
            "The broker at {where} cannot be reached: {first}. Heliopanel retries automatically.",
            where=self._where,
            first=first,
        )
        self._door.trouble(MQTT_NAME, Condition("gateway_down", None, SITE, self._error))
        log.warning("mqtt_disconnected", reason=str(first), broker=self._where)

    @asynccontextmanager
    async def _connected(self) -> AsyncIterator[Client]:
        """Connect with a last will, hear commands, say that we are online, and take it back at the end."""
        async with self._client() as client:
            if self._settings.mqtt_commands and self._protocol is ProtocolVersion.V5:
                await client.subscribe(self._topics.commands, options=HEARD)
            await client.publish(self._topics.availability, ONLINE, AT_LEAST_ONCE, retain=True)
            self._status, self._error, self._announced = GatewayStatus.CONNECTED, self._deaf, {}
            self._alarms = None
            self._door.trouble(MQTT_NAME, None)
            log.info("mqtt_connected", broker=self._where)
            try:
                yield client
            finally:
                self._status = GatewayStatus.CONNECTING
                with suppress(MqttError):
                    await client.publish(
                        self._topics.availability, OFFLINE, AT_LEAST_ONCE, retain=True, timeout=1.0
                    )

    def _client(self) -> Client:
        settings = self._settings
        password = settings.mqtt_password
        return Client(
            settings.mqtt_host or "",
            self._port,
            username=settings.mqtt_username,
            password=None if password is None else password.get_secret_value(),
            identifier=settings.mqtt_client_id,
            will=Will(self._topics.availability, OFFLINE, AT_LEAST_ONCE, retain=True),
            tls_params=self._tls() if settings.mqtt_tls else None,
            timeout=ANSWER_WITHIN_S,
            keepalive=KEEPALIVE_S,
            max_queued_incoming_messages=MOST_COMMANDS_WAITING,
            logger=quiet_logger(self._clock),
            protocol=self._protocol,
        )

    def _tls(self) -> TLSParameters:
        settings = self._settings
        return TLSParameters(
            ca_certs=_path(settings.mqtt_ca_file),
            certfile=_path(settings.mqtt_cert_file),
            keyfile=_path(settings.mqtt_key_file),
        )

    async def _tell(self, client: Client) -> None:
        client.pending_calls_threshold = 2 * AT_ONCE
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._tell_snapshots(client))
            tasks.create_task(self._tell_events(client))
            tasks.create_task(self._tell_recordings(client))
            tasks.create_task(self._take_commands(client))

    async def _tell_snapshots(self, client: Client) -> None:
        """Tell the newest snapshot at the set rate; what could not be told in time is left out."""
        due = self._clock.now()
        while True:
            site = self._door.latest()
            if site is not None:
                await self._announce(client, site)
                await self._tell_site(client, site)
                await self._tell_alarms(client, site)
            due = max(due + self._every, self._clock.now())
            await self._clock.sleep_until(due)

    async def _tell_site(self, client: Client, site: SiteSnapshot) -> None:
        await heeding(client.publish(self._topics.site, site_payload(site)))
        if self._settings.mqtt_payload == "columns":
            await heeding(client.publish(self._topics.columns, columns_payload(site)))
            return
        for tracker in site.trackers:
            topic = self._topics.snapshot(tracker.tracker_id)
            await heeding(client.publish(topic, tracker_payload(site, tracker)))

    async def _tell_alarms(self, client: Client, site: SiteSnapshot) -> None:
        """Retain every alarm that stands, and take back those that ended; what is the same is not told."""
        standing = {self._topics.alarm(one.alarm_id): alarm_payload(one) for one in site.alarms}
        if standing == self._alarms:
            return
        before = await asyncio.to_thread(self._outbox.retained_alarms)
        await asyncio.to_thread(self._outbox.retain_alarms, sorted({*before, *standing}))
        gone = {topic: b"" for topic in before if topic not in standing}
        for topic, payload in (gone | standing).items():
            if (self._alarms or {}).get(topic) != payload:
                await heeding(client.publish(topic, payload, AT_LEAST_ONCE, retain=True))
        await asyncio.to_thread(self._outbox.retain_alarms, sorted(standing))
        self._alarms = standing

    async def _announce(self, client: Client, site: SiteSnapshot) -> None:
        """Announce trackers that are new or changed to Home Assistant, and take back those that are gone."""
        if not self._settings.mqtt_discovery:
            return
        wanted = announcements(self._topics, site.trackers, commands=self._settings.mqtt_commands)
        gone = dict.fromkeys(self._announced.keys() - wanted.keys(), b"")
        for topic, payload in (wanted | gone).items():
            if self._announced.get(topic) != payload:
                await heeding(client.publish(topic, payload, AT_LEAST_ONCE, retain=True))
        self._announced = wanted

    async def _tell_events(self, client: Client) -> None:
        """Tell the journal in its order; what the broker has not acknowledged is told again."""
        while True:
            entries = await asyncio.to_thread(self._outbox.events, AT_ONCE)
            payloads = [event_payload(self._outbox.series, entry) for entry in entries]
            topic = self._topics.events
            async with asyncio.TaskGroup() as tasks:
                for payload in payloads:
                    tasks.create_task(client.publish(topic, payload, AT_LEAST_ONCE))
            if entries:
                await asyncio.to_thread(self._outbox.acknowledge, entries[-1])
            if len(entries) < AT_ONCE:
                self._waiting = 0
                await self._clock.sleep_until(self._clock.now() + LOOK_FOR_EVENTS)

    async def _tell_recordings(self, client: Client) -> None:
        while True:
            for recording in await asyncio.to_thread(self._outbox.recordings):
                payload = recording_payload(recording)
                await heeding(client.publish(self._topics.recordings, payload, AT_LEAST_ONCE))
                await asyncio.to_thread(self._outbox.announced, recording)
            await self._clock.sleep_until(self._clock.now() + LOOK_FOR_RECORDINGS)

    async def _take_commands(self, client: Client) -> None:
        """Hand every command to its lane: a stop is carried out at once, the others in their order."""
        lanes = CommandLanes(self._door, self._clock, self._answer_to(client))
        async with asyncio.TaskGroup() as tasks:
            lanes.start(tasks)
            async for message in client.messages:
                if isinstance(message.payload, bytes) and message.payload:
                    tracker_id = self._topics.addressed(message.topic.value)
                    lanes.take(tracker_id, message.payload, retained=message.retain)

    def _answer_to(self, client: Client) -> Callable[[str, bytes], Awaitable[None]]:
        async def answer(tracker_id: str, text: bytes) -> None:
            await heeding(client.publish(self._topics.result(tracker_id), text, AT_LEAST_ONCE))

        return answer

    async def _count_waiting(self) -> None:
        with suppress(StoreFailed):
            self._waiting = await asyncio.to_thread(self._outbox.waiting)


async def heeding(work: Coroutine[None, None, T]) -> T:
    """Return what it returns; a cancellation that it swallowed is raised after all.

    The client waits with `asyncio.wait_for`, which before Python 3.12 drops a cancellation that comes
    together with the result. A loop would then go on for ever, and the controller service would not end.
    """
    result = await work
    task = asyncio.current_task()
    if task is not None and task.cancelling():
        raise asyncio.CancelledError
    return result


def quiet_logger(clock: Clock) -> logging.Logger:
    """Return the library's logger, which says the same once a minute: it warns of every message of a flood.

    Each warning is written before the next tick; a flood of them on a busy disk held up stops for 0.4 s.
    """
    said: dict[str, datetime] = {}

    def is_news(record: logging.LogRecord) -> bool:
        now, last = clock.now(), said.get(record.msg)
        if last is not None and now - last < SAY_AGAIN:
            return False
        said[record.msg] = now
        return True

    logger = logging.Logger("mqtt")
    logger.parent = logging.getLogger()
    logger.addFilter(is_news)
    return logger


def _path(file: Path | None) -> str | None:
    return None if file is None else str(file)
