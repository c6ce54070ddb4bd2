"""What `create_app` built, with its types, for the routes."""

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.clock import Clock
from app.link.messages import Machine, MachineUnreachable, Order, SiteCommand
from app.settings import Settings
from app.store.store import Reader
from app.tracker.commands import Command
from app.tracker.snapshot import SiteSnapshot
from app.web.assets import Assets
from app.web.errors import NotAcceptable
from app.web.hub import Hub
from app.web.simulations import Simulations
from app.web.studies import Studies

OPERATOR = "operator"


@dataclass(frozen=True, slots=True)
class Panel:
    """Everything that one panel consists of."""

    settings: Settings
    machine: Machine
    reader: Reader
    clock: Clock
    assets: Assets
    hub: Hub
    simulations: Simulations
    studies: Studies


def panel(connection: HTTPConnection) -> Panel:
    """Return what `create_app` built."""
    built: Panel = connection.app.state.panel
    return built


PanelDep = Annotated[Panel, Depends(panel)]


def _machine(built: PanelDep) -> Machine:
    return built.machine


def _reader(built: PanelDep) -> Reader:
    return built.reader


MachineDep = Annotated[Machine, Depends(_machine)]
ReaderDep = Annotated[Reader, Depends(_reader)]


def _snapshot(built: PanelDep) -> SiteSnapshot:
    snapshot = built.machine.latest()
    if snapshot is None:
        raise MachineUnreachable
    return snapshot


SnapshotDep = Annotated[SiteSnapshot, Depends(_snapshot)]


async def order(
    machine: Machine, command: Command | SiteCommand, tracker_id: str | None = None, *, key: str | None = None
) -> SiteSnapshot:
    """Send one order of the operator's to the machine; what it calls impossible becomes a 422."""
    try:
        return await machine.execute(Order(command, OPERATOR, tracker_id, key))
    except ValueError as error:
        raise NotAcceptable(str(error)) from error
