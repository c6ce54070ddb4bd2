"""Orders about where alarms are sent; the sending itself is a gateway's business."""

from dataclasses import replace
from urllib.parse import urlsplit

from app.hosts import checked_host
from app.link.alarm_orders import NotificationOrder, SetNotifications
from app.site.model import SiteModel
from app.tracker.commands import CommandRejected
from app.tracker.notifications import Channel, Notifications
from app.tracker.reason import Reason
from app.tracker.snapshot import Event, EventKind

NAMES = {Channel.WEBHOOK: "webhook", Channel.MAIL: "e-mail"}


async def carry_out(model: SiteModel, command: NotificationOrder, actor: str) -> tuple[Event, ...]:
    """Store where alarms are sent, or journal a test message, which every gateway reads there."""
    if isinstance(command, SetNotifications):
        _check_hosts(command.notifications)
        event = model.event(EventKind.NOTIFICATIONS_SET, _says(command.notifications), actor)
        state = replace(model.state, notifications=command.notifications)
        await model.ledger.save_site(state, (event,))
        model.state = state
        return (event,)
    name = NAMES[command.channel]
    if not model.state.notifications.reaches(command.channel):
        raise CommandRejected(
            Reason("no_address", f"There is no address for {name}.", "Enter one and save it first.")
        )
    text = f"A test message by {name} was requested."
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


def _says(wanted: Notifications) -> str:
    parts = [
        f"{NAMES[channel]} with priority {', '.join(map(str, wanted.priorities(channel)))}"
        for channel in Channel
        if wanted.reaches(channel) and wanted.priorities(channel)
    ]
    return f"Alarms are sent by {' and by '.join(parts)}." if parts else "Alarms are not sent."
