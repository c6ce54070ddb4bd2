"""Orders about where alarms are sent; the sending itself is a gateway's business."""

from dataclasses import replace
from urllib.parse import urlsplit

from app.base.hosts import checked_host
from app.base.message import N_, Message, join, say
from app.link.alarm_orders import SetNotifications, TestNotification
from app.site.state.model import SiteModel
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.notifications import Channel, Notifications
from app.tracker.values.reason import Reason

NAMES = {Channel.WEBHOOK: "webhook", Channel.MAIL: "e-mail"}


async def set_notifications(model: SiteModel, command: SetNotifications, actor: str) -> tuple[Event, ...]:
    """Store where alarms are sent."""
    _check_hosts(command.notifications)
    event = model.event(EventKind.NOTIFICATIONS_SET, _says(command.notifications), actor)
    state = replace(model.state, notifications=command.notifications)
    await model.ledger.save_site(state, (event,))
    model.state = state
    return (event,)


async def test(model: SiteModel, command: TestNotification, actor: str) -> tuple[Event, ...]:
    """Journal a test message, which every gateway reads there."""
    name = NAMES[command.channel]
    if not model.state.notifications.reaches(command.channel):
        raise CommandRejected(
            Reason(
                "no_address",
                say("There is no address for {name}.", name=name),
                N_("Enter one and save it first."),
            )
        )
    text = say("A test message by {name} was requested.", name=name)
    event = model.event(EventKind.NOTIFICATION_TESTED, text, actor, channel=command.channel.value)
    await model.ledger.append((event,))
    return (event,)


def _check_hosts(wanted: Notifications) -> None:
    """Raise `ValueError` for an address whose host can be none."""
    hosts = [address.partition("@")[2] for address in wanted.mail_to]
    if wanted.webhook_url:
        hosts.append(urlsplit(wanted.webhook_url).hostname or "")
    for host in hosts:
        checked_host(host)


def _says(wanted: Notifications) -> Message:
    parts = [
        say(
            "{names} with priority {join}",
            names=NAMES[channel],
            join=", ".join(map(str, wanted.priorities(channel))),
        )
        for channel in Channel
        if wanted.reaches(channel) and wanted.priorities(channel)
    ]
    return (
        say("Alarms are sent by {parts}.", parts=join(" and ", parts))
        if parts
        else N_("Alarms are not sent.")
    )
