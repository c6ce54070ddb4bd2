"""What the controller counts about itself, or that it does not answer."""

from typing import Protocol, runtime_checkable

from app.link.messages import MachineUnreachable
from app.link.metrics import MachineMetrics


@runtime_checkable
class Counting(Protocol):
    """A controller that counts what it does."""

    async def metrics(self) -> MachineMetrics:
        """Return what was counted."""


async def counted(machine: object) -> MachineMetrics | None:
    """Return what the controller counts, None if it does not answer or does not count."""
    if not isinstance(machine, Counting):
        return None
    try:
        return await machine.metrics()
    except MachineUnreachable:
        return None
