"""The MQTT gateway: tells snapshots, events and recordings, and takes commands if it may.

The machine never waits for the broker: snapshots are taken from the newest one there is, events from the
journal on disk, and both by tasks of their own.
"""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from contextlib import asynccontextmanager, suppress
from datetime import datetime, timedelta
from itertools import takewhile
from typing import TypeVar

from aiomqtt import MqttError, ProtocolVersion
from paho.mqtt.reasoncodes import ReasonCode
from paho.mqtt.subscribeoptions import SubscribeOptions

from app.alarms.conditions import SITE, Condition
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, NOTHING, Message, join, plain, say, told_by
from app.base.settings import Settings
from app.gateway.mqtt_client import AT_LEAST_ONCE, BrokerClient, Reason, Refused, broker_client, broker_port
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
from app.gateway.mqtt_reasons import TAKEN_OVER, UNSUPPORTED_VERSION, told_reason
from app.gateway.outbox import Outbox
from app.gateway.ports import MQTT_NAME, Door
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.store.store import StoreFailed
from app.tracker.state.snapshot import SiteSnapshot

FIRST_DELAY, LONGEST_DELAY = timedelta(seconds=1), timedelta(seconds=30)
LONGEST_WHEN_TAKEN_OVER = timedelta(minutes=5)
CUT_OFF_OFTEN = 3
"""So many connections in a row that the broker ended without a reason are more than an accident."""
LOOK_FOR_EVENTS = timedelta(milliseconds=500)
LOOK_FOR_RECORDINGS = timedelta(seconds=5)
AT_ONCE = 50
MOST_REFUSED = 10_000
HEARD = SubscribeOptions(
    qos=AT_LEAST_ONCE,
    retainAsPublished=True,
    retainHandling=SubscribeOptions.RETAIN_DO_NOT_SEND,
)
"""A command that was sent to be retained keeps its flag; what was retained before is not sent at all."""

T = TypeVar("T")
Retained = dict[str, bytes | None]
"""What the broker retains for us, by topic; None is what an earlier connection left there."""

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
        self._announced: Retained = {}
        self._alarms: Retained | None = None
        self._refused: dict[str, tuple[datetime, Message]] = {}
        self._cut_off = 0
        self._protocol = ProtocolVersion.V5

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        connected = self._status is GatewayStatus.CONNECTED
        now = self._clock.now()
        refused = (told for again, told in self._refused.values() if now < again + LONGEST_DELAY)
        error = self._error or next(refused, NOTHING)
        return GatewayMetrics(
            MQTT_NAME, self._status, plain(self._where), int(connected), error, self._waiting
        )

    @property
    def _where(self) -> str:
        return f"{self._settings.mqtt_host}:{broker_port(self._settings)}"

    async def run(self) -> None:
        """Connect, tell, and connect again, until cancelled."""
        delay = timedelta()
        while True:
            client = broker_client(self._settings, self._clock, self._topics.availability, self._protocol)
            began = self._clock.now()
            try:
                await asyncio.to_thread(self._outbox.begin)
                async with self._connected(client):
                    await self._tell(client)
            except* (MqttError, StoreFailed, OSError) as errors:
                delay = self._note_failure(errors, client, delay, lasted=self._clock.now() - began)
            finally:
                client.close()
            await self._count_waiting()
            await self._clock.sleep_until(self._clock.now() + delay)

    def _note_failure(
        self, errors: ExceptionGroup[Exception], client: BrokerClient, delay: timedelta, *, lasted: timedelta
    ) -> timedelta:
        """Note why there is no connection, and return how long to wait before the next one."""
        first: BaseException = errors
        while isinstance(first, BaseExceptionGroup):
            first = first.exceptions[0]
        self._status = GatewayStatus.CONNECTING
        reason = client.reason
        code = None if reason is None else reason.code
        if client.was_accepted:
            is_cut_off = code is None and isinstance(first, MqttError) and lasted < LONGEST_DELAY
            self._cut_off = self._cut_off + 1 if is_cut_off else 0
        self._protocol = ProtocolVersion.V5
        if code == UNSUPPORTED_VERSION:
            self._protocol = ProtocolVersion.V311
            log.warning("mqtt_older_broker", broker=self._where, commands="none are taken")
        self._error = self._told(reason) if reason is not None else self._unexplained(first, client)
        self._door.trouble(MQTT_NAME, Condition("gateway_down", None, SITE, self._error))
        delay = next_delay(delay, lasted, LONGEST_WHEN_TAKEN_OVER if code == TAKEN_OVER else LONGEST_DELAY)
        log.warning(
            "mqtt_disconnected",
            reason=str(first),
            code=code,
            told=str(self._error),
            broker=self._where,
            again_s=delay.total_seconds(),
        )
        return delay

    def _told(self, reason: Reason) -> Message:
        settings = self._settings
        return told_reason(
            reason.code,
            where=self._where,
            client_id=settings.mqtt_client_id,
            base=settings.mqtt_base_topic,
            server=reason.server,
        )

    def _unexplained(self, first: BaseException, client: BrokerClient) -> Message:
        """Return what to say of an end that the broker did not explain, or that was not its doing."""
        where = self._where
        if not isinstance(first, MqttError):
            return say(
                "Events for the broker cannot be read or noted: {first}. Heliopanel retries automatically.",
                first=told_by(first),
            )
        if self._cut_off >= CUT_OFF_OFTEN:
            return say(
                "The broker at {where} ends every connection soon, without a reason. If another client uses "
                "the ID {client_id}, set another one with HELIOPANEL_MQTT_CLIENT_ID.",
                where=where,
                client_id=self._settings.mqtt_client_id,
            )
        if client.was_accepted:
            return say(
                "The connection to the broker at {where} was lost. Heliopanel retries automatically.",
                where=where,
            )
        return say(
            "The broker at {where} cannot be reached: {first}. Heliopanel retries automatically.",
            where=where,
            first=first,
        )

    @asynccontextmanager
    async def _connected(self, client: BrokerClient) -> AsyncIterator[None]:
        """Connect with a last will, hear commands, say that we are online, and take it back at the end."""
        async with client:
            self._refused, self._announced, self._alarms = {}, {}, None
            self._error = await self._hear(client)
            await self._tell_surely(client, self._topics.availability, ONLINE, retain=True)
            self._status = GatewayStatus.CONNECTED
            self._door.trouble(MQTT_NAME, None)
            log.info("mqtt_connected", broker=self._where)
            try:
                yield
            finally:
                with suppress(MqttError):
                    await client.publish(
                        self._topics.availability, OFFLINE, AT_LEAST_ONCE, retain=True, timeout=1.0
                    )

    async def _tell(self, client: BrokerClient) -> None:
        client.pending_calls_threshold = 2 * AT_ONCE
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._tell_snapshots(client))
            tasks.create_task(self._tell_events(client))
            tasks.create_task(self._tell_recordings(client))
            tasks.create_task(self._take_commands(client))
            tasks.create_task(self._hear_later(client))

    async def _tell_snapshots(self, client: BrokerClient) -> None:
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

    async def _tell_site(self, client: BrokerClient, site: SiteSnapshot) -> None:
        await heeding(client.publish(self._topics.site, site_payload(site)))
        if self._settings.mqtt_payload == "columns":
            await heeding(client.publish(self._topics.columns, columns_payload(site)))
            return
        for tracker in site.trackers:
            topic = self._topics.snapshot(tracker.tracker_id)
            await heeding(client.publish(topic, tracker_payload(site, tracker)))

    async def _tell_alarms(self, client: BrokerClient, site: SiteSnapshot) -> None:
        """Retain every alarm that stands, and take back those that ended; what is the same is not told."""
        standing = {self._topics.alarm(one.alarm_id): alarm_payload(one) for one in site.alarms}
        if standing == self._alarms:
            return
        if self._alarms is None:
            self._alarms = dict.fromkeys(await asyncio.to_thread(self._outbox.retained_alarms))
        await asyncio.to_thread(self._outbox.retain_alarms, sorted({*self._alarms, *standing}))
        await self._retain(client, self._alarms, standing)
        await asyncio.to_thread(self._outbox.retain_alarms, sorted({*self._alarms, *standing}))

    async def _announce(self, client: BrokerClient, site: SiteSnapshot) -> None:
        """Announce trackers that are new or changed to Home Assistant, and take back those that are gone."""
        if self._settings.mqtt_discovery:
            wanted = announcements(self._topics, site.trackers, commands=self._settings.mqtt_commands)
            await self._retain(client, self._announced, wanted)

    async def _retain(self, client: BrokerClient, held: Retained, wanted: dict[str, bytes]) -> None:
        """Retain what is wanted and take the rest back; `held` is what the broker has, and follows."""
        gone = {topic: b"" for topic in held if topic not in wanted}
        for topic, payload in (wanted | gone).items():
            if held.get(topic, b"") == payload:
                continue
            if await self._tell_surely(client, topic, payload, retain=True):
                held[topic] = payload
                if not payload:
                    del held[topic]

    async def _tell_surely(
        self, client: BrokerClient, topic: str, payload: str | bytes, *, retain: bool = False
    ) -> bool:
        """Tell something at least once, and return whether the broker took it.

        What it refuses is shown, and not sent again before a while has passed; the rest goes its way.
        """
        again = self._refused.get(topic)
        if again is not None and self._clock.now() < again[0]:
            return False
        try:
            await heeding(client.publish(topic, payload, AT_LEAST_ONCE, retain=retain))
        except Refused as refusal:
            sentence = join(
                " ",
                (say("Messages on {topic} are not accepted.", topic=topic), self._told(refusal.reason)),
            )
            if len(self._refused) < MOST_REFUSED:
                self._refused[topic] = self._clock.now() + LONGEST_DELAY, sentence
            log.warning("mqtt_refused", topic=topic, code=refusal.reason.code, broker=self._where)
            return False
        if self._refused.get(topic) is again:
            self._refused.pop(topic, None)
        return True

    async def _tell_events(self, client: BrokerClient) -> None:
        """Tell the journal in its order; what the broker has not acknowledged is told again."""
        while True:
            entries = await asyncio.to_thread(self._outbox.events, AT_ONCE)
            payloads = [event_payload(self._outbox.series, entry) for entry in entries]
            async with asyncio.TaskGroup() as tasks:
                told = [
                    tasks.create_task(self._tell_surely(client, self._topics.events, payload))
                    for payload in payloads
                ]
            arrived = list(takewhile(lambda pair: pair[1].result(), zip(entries, told, strict=True)))
            if arrived:
                await asyncio.to_thread(self._outbox.acknowledge, arrived[-1][0])
            if len(arrived) < AT_ONCE:
                self._waiting = len(entries) - len(arrived)
                await self._clock.sleep_until(self._clock.now() + LOOK_FOR_EVENTS)

    async def _tell_recordings(self, client: BrokerClient) -> None:
        while True:
            for recording in await asyncio.to_thread(self._outbox.recordings):
                if await self._tell_surely(client, self._topics.recordings, recording_payload(recording)):
                    await asyncio.to_thread(self._outbox.announced, recording)
            await self._clock.sleep_until(self._clock.now() + LOOK_FOR_RECORDINGS)

    async def _hear(self, client: BrokerClient) -> Message:
        """Subscribe to the commands if they are allowed, and return why none are heard, empty if they are."""
        if not self._settings.mqtt_commands:
            return NOTHING
        if self._protocol is not ProtocolVersion.V5:
            return say(
                "The broker at {where} does not speak MQTT 5, so no commands are accepted.", where=self._where
            )
        for granted in await heeding(client.subscribe(self._topics.commands, options=HEARD)):
            if isinstance(granted, ReasonCode) and granted.is_failure:
                log.warning("mqtt_not_heard", code=granted.value, broker=self._where)
                told = self._told(Reason(granted.value))
                return join(" ", (N_("No commands are received over MQTT."), told))
        return NOTHING

    async def _hear_later(self, client: BrokerClient) -> None:
        """Subscribe again from time to time while the broker refuses it."""
        while self._settings.mqtt_commands and self._protocol is ProtocolVersion.V5 and self._error:
            await self._clock.sleep_until(self._clock.now() + LONGEST_DELAY)
            self._error = await self._hear(client)

    async def _take_commands(self, client: BrokerClient) -> None:
        """Hand every command to its lane: a stop is carried out at once, the others in their order."""
        lanes = CommandLanes(self._door, self._clock, self._answer_to(client))
        async with asyncio.TaskGroup() as tasks:
            lanes.start(tasks)
            async for message in client.messages:
                if isinstance(message.payload, bytes) and message.payload:
                    tracker_id = self._topics.addressed(message.topic.value)
                    if tracker_id is not None:
                        lanes.take(tracker_id, message.payload, retained=message.retain)

    def _answer_to(self, client: BrokerClient) -> Callable[[str, bytes], Awaitable[None]]:
        async def answer(tracker_id: str, text: bytes) -> None:
            await self._tell_surely(client, self._topics.result(tracker_id), text)

        return answer

    async def _count_waiting(self) -> None:
        with suppress(StoreFailed):
            self._waiting = await asyncio.to_thread(self._outbox.waiting)


def next_delay(delay: timedelta, lasted: timedelta, longest: timedelta) -> timedelta:
    """Return how long to wait after a connection, twice as long as before unless it lasted.

    Two clients with one id that take the connection from each other thereby do so ever more seldom.
    """
    return FIRST_DELAY if lasted > 2 * longest else max(FIRST_DELAY, min(2 * delay, longest))


async def heeding(work: Coroutine[None, None, T]) -> T:
    """Return what it returns; a cancellation that it swallowed is raised after all.

    The client waits with `asyncio.wait_for`, which before Python 3.12 drops a cancellation that comes
    together with the result. A loop would then go on for ever, and the controller service would not end.
    """
    task = asyncio.current_task()
    before = 0 if task is None else task.cancelling()
    result = await work
    if task is not None and task.cancelling() > before:
        raise asyncio.CancelledError
    return result
