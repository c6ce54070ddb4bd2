"""What a gateway needs of the machine: orders in, updates out, and the journal."""

from typing import Protocol

from app.alarms.conditions import Condition
from app.base.message import Message, plain, say, told_by
from app.link.messages import Machine, Order, RequestControl, Update
from app.tracker.commands.commands import Command, CommandRejected
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot
from app.tracker.values.notifications import Notifications

__all__ = ["MQTT_NAME", "Door", "Update", "refused", "send", "written"]


SUNSPEC, MQTT = "sunspec", "mqtt"
"""How orders of these doors are known; each is one holder of control, whichever host or client wrote."""
MQTT_NAME = plain("MQTT")
"""How that gateway is called where people read; here, so that its library loads only where it is used."""


class Door(Machine, Protocol):
    """A machine whose journal takes notes, too."""

    def note(self, *events: Event) -> None:
        """Journal and tell what happened at this door."""

    def trouble(self, name: str, condition: Condition | None) -> None:
        """Note a condition that is for the alarms, or with None that it is over."""

    @property
    def notifications(self) -> Notifications:
        """Return where alarms are to be sent."""


async def send(door: Door, command: Command | RequestControl, tracker_id: str | None, actor: str) -> None:
    """Send one order of SunSpec's; one that is refused is journalled with its reasons before it raises."""
    try:
        await door.execute(Order(command, actor, tracker_id, via=SUNSPEC))
    except CommandRejected as rejected:
        refused(
            door,
            tracker_id,
            actor,
            say("{kind} was refused: {rejected}", kind=command.kind, rejected=told_by(rejected)),
        )
        raise


def written(door: Door, tracker_id: str | None, actor: str, message: Message) -> None:
    """Journal what was written."""
    _note(door, EventKind.REMOTE_WRITTEN, tracker_id, actor, message)


def refused(door: Door, tracker_id: str | None, actor: str, message: Message) -> None:
    """Journal what was refused."""
    _note(door, EventKind.REMOTE_REFUSED, tracker_id, actor, message)


def _note(door: Door, kind: EventKind, tracker_id: str | None, actor: str, message: Message) -> None:
    site: SiteSnapshot | None = door.latest()
    if site is not None:
        door.note(Event(site.at, kind, tracker_id, message, actor))
