"""Sends alarms by one channel, in order, out of the journal; the machine never waits for it."""

import asyncio
from collections.abc import Callable
from datetime import timedelta

from app.alarms.conditions import SITE, Condition
from app.base.addresses.masking import masked
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_, NOTHING, Message, plain, say, told_by
from app.base.settings import Settings
from app.gateway.notices import NotDelivered
from app.gateway.outbox import Outbox
from app.gateway.ports import Door
from app.link.metrics import GatewayMetrics, GatewayStatus
from app.store.store import JournalEntry, StoreFailed
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.notifications import Channel, Notifications

LOOK_EVERY = timedelta(seconds=1)
FIRST_DELAY, LONGEST_DELAY = timedelta(seconds=2), timedelta(minutes=5)
AT_ONCE = 50
FAILED = "notification_failed"
OFF = N_("enter an address on this page to enable it")

Deliver = Callable[[Settings, Notifications, str, JournalEntry], None]

log = get_logger()


class Notifier:
    """Keeps its place in the journal on disk: what could not be sent is sent later, once and in order."""

    def __init__(
        self,
        name: str,
        channel: Channel,
        deliver: Deliver,
        door: Door,
        clock: Clock,
        settings: Settings,
        outbox: Outbox,
    ) -> None:
        self._name = name
        self._channel = channel
        self._deliver = deliver
        self._door = door
        self._clock = clock
        self._settings = settings
        self._outbox = outbox
        self._error = NOTHING
        self._waiting = 0
        self._delay = FIRST_DELAY
        self._begun = False

    def metrics(self) -> GatewayMetrics:
        """Return how it is doing."""
        if not self._door.notifications.reaches(self._channel):
            return GatewayMetrics(self._name, GatewayStatus.OFF, OFF)
        status = GatewayStatus.CONNECTING if self._error else GatewayStatus.CONNECTED
        return GatewayMetrics(self._name, status, plain(self._where()), 0, self._error, self._waiting)

    async def run(self) -> None:
        """Send what the journal has, and look again, until cancelled."""
        while True:
            try:
                await self._begin_and_send()
            except StoreFailed as error:
                log.warning("notifications_wait", channel=self._channel, reason=str(error))
            await self._clock.sleep_until(self._clock.now() + (self._delay if self._error else LOOK_EVERY))

    async def _begin_and_send(self) -> None:
        if not self._begun:
            await asyncio.to_thread(self._outbox.begin)
            self._begun = True
        if not self._door.notifications.reaches(self._channel):
            await self._pass_over()
            return
        await asyncio.to_thread(self._outbox.keep)
        while entries := await asyncio.to_thread(self._outbox.events, AT_ONCE):
            for entry in entries:
                if not await self._send(entry):
                    self._waiting = await asyncio.to_thread(self._outbox.waiting)
                    return
            await asyncio.to_thread(self._outbox.acknowledge, entries[-1])
        self._waiting = 0

    async def _pass_over(self) -> None:
        """Go on to the end of the journal: whoever opens the channel later hears of what happens then."""
        newest = await asyncio.to_thread(self._outbox.newest)
        if newest is not None:
            self._turn(NOTHING)
            await asyncio.to_thread(self._outbox.skip, newest)
        self._waiting = 0

    async def _send(self, entry: JournalEntry) -> bool:
        """Send an entry if it is to be sent; return whether it is dealt with."""
        wanted = self._door.notifications
        if not is_sent(entry.event, self._channel, wanted):
            if not wanted.reaches(self._channel):
                self._turn(NOTHING)
            return True
        series = await asyncio.to_thread(lambda: self._outbox.series)
        try:
            await asyncio.to_thread(self._deliver, self._settings, wanted, series, entry)
        except NotDelivered as failure:
            self._turn(say("{failure} Heliopanel retries automatically.", failure=told_by(failure)))
            self._delay = min(2 * self._delay, LONGEST_DELAY)
            return False
        self._turn(NOTHING)
        await asyncio.to_thread(self._outbox.acknowledge, entry)
        return True

    def _turn(self, error: Message) -> None:
        """Note how the last message fared; a failure is an alarm until one arrives."""
        if error:
            log.warning("notification_failed", channel=self._channel, reason=error)
            self._door.trouble(
                self._name,
                Condition(FAILED, None, SITE, say("{name}: {error}", name=self._name, error=error)),
            )
        elif self._error:
            self._door.trouble(self._name, None)
        if not error:
            self._delay = FIRST_DELAY
        self._error = error

    def _where(self) -> str:
        wanted = self._door.notifications
        return masked(wanted.webhook_url) if self._channel is Channel.WEBHOOK else ", ".join(wanted.mail_to)


def is_sent(event: Event, channel: Channel, wanted: Notifications) -> bool:
    """Return whether a channel sends an event: alarms of its priorities, and its own test message.

    That messages are not delivered is an alarm itself; it is not sent, it would only wait in the same line.
    """
    if not wanted.reaches(channel):
        return False
    if event.kind is EventKind.NOTIFICATION_TESTED:
        return event.data.get("channel") == channel.value
    if event.kind not in (EventKind.ALARM_RAISED, EventKind.ALARM_RETURNED):
        return False
    return event.data["priority"] in wanted.priorities(channel) and event.data["code"] != FAILED
