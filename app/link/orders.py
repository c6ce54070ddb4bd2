"""Every order that there is, by its kind."""

from typing import get_args

from app.link.messages import SiteCommand
from app.tracker.commands.commands import Command

AnyOrder = Command | SiteCommand


def kind_of(order: type[AnyOrder]) -> str:
    """Return the kind by which an order is known in JSON."""
    return str(order.__dataclass_fields__["kind"].default)


KINDS: dict[str, type[AnyOrder]] = {kind_of(one): one for one in (*get_args(Command), *get_args(SiteCommand))}
