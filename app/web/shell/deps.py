"""What `create_app` built, with its types, for the routes."""

from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.access.authenticator import Keeper
from app.access.principal import Principal, nobody
from app.base.clock import Clock
from app.base.message import say
from app.base.settings import Settings
from app.link.messages import Machine, MachineUnreachable, Order, SiteCommand
from app.store.store import Reader
from app.studies.folder import StudyUnknown
from app.tracker.commands.commands import Command
from app.tracker.state.snapshot import SiteSnapshot
from app.web.http.assets import Assets
from app.web.http.manual import Manual, own_manual
from app.web.http.network import NetworkDesk
from app.web.live.hub import Hub
from app.web.services.narrowed import NarrowedMachine, NarrowedReader, sees_study
from app.web.services.simulations import Simulations
from app.web.services.studies import Studies


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
    keeper: Keeper
    network: NetworkDesk
    manual: Manual = field(default_factory=own_manual)

    def site_now(self) -> datetime:
        """Return the site's time; the system's while the controller does not tell it."""
        latest = self.machine.latest()
        return latest.at if latest else self.clock.system_time()


def panel(connection: HTTPConnection) -> Panel:
    """Return what `create_app` built; for who reaches some trackers only, with those alone."""
    built: Panel = connection.app.state.panel
    trackers = principal(connection).trackers
    if trackers is None:
        return built
    machine, reader = NarrowedMachine(built.machine, trackers), NarrowedReader(built.reader, trackers)
    return replace(built, machine=machine, reader=reader)


def _asked(connection: HTTPConnection) -> Panel:
    """Return the same for a route, whose study, if it names one, must be about what may be seen."""
    built, study_id = panel(connection), connection.path_params.get("study_id")
    trackers = principal(connection).trackers
    if study_id is not None and not sees_study(built.studies, study_id, trackers):
        raise StudyUnknown(say("There is no study {study_id}.", study_id=study_id))
    return built


PanelDep = Annotated[Panel, Depends(_asked)]


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


def principal(connection: HTTPConnection) -> Principal:
    """Return who asks, as the gate found out; nobody where no gate stood."""
    found: Principal | None = connection.scope.get("state", {}).get("principal")
    return found or nobody("")


PrincipalDep = Annotated[Principal, Depends(principal)]


def order_of(
    who: Principal,
    command: Command | SiteCommand,
    tracker_id: str | None = None,
    key: str | None = None,
    issued_at: datetime | None = None,
    epoch: int | None = None,
) -> Order:
    """Return somebody's order, or raise the error that says why they may not give it.

    `epoch` is the one of control that it was given under, None where that is not known.
    """
    about = tracker_id or getattr(command, "tracker_id", None)
    who.require_order(command.kind, command.spec, about)
    return Order(command, who.actor, tracker_id, key, issued_at, who.via.value, who.address, epoch, who.rank)
