"""Playing faults on a tracker that is simulated in this process, for training; all of it is journaled."""

from app.drives.corrected import CorrectedDrive
from app.drives.drive import Drive
from app.drives.faults import Fault, FaultKind
from app.drives.simulated import SimulatedDrive
from app.drives.transmitted import TransmittedDrive
from app.link.messages import ClearFaults, PlayFault
from app.site.model import SiteModel
from app.tracker.commands import CommandRejected
from app.tracker.reason import Reason
from app.tracker.snapshot import Event, EventKind
from app.tracker.training import lesson


async def carry_out(model: SiteModel, command: PlayFault | ClearFaults, actor: str) -> tuple[Event, ...]:
    """Play a fault or end all of them, or raise `CommandRejected` on a tracker that is real."""
    loop = model.tracker(command.tracker_id)
    name, machine = loop.config.name, _simulated(loop.drive)
    if machine is None:
        raise CommandRejected(
            Reason(
                "not_simulated",
                f"{name} is not simulated by this program; faults are played on a simulated tracker only.",
                "Add a simulated tracker for training, or play faults in heliopanel drive-sim.",
            )
        )
    if isinstance(command, ClearFaults):
        machine.clear_faults()
        text = f"TRAINING: the faults of {name} that were played are ended."
        event = model.event(EventKind.FAULTS_CLEARED, text, actor, command.tracker_id)
    else:
        taught = lesson(command.fault)
        machine.inject(Fault(FaultKind(taught.fault), taught.axis, taught.amount))
        text = f"TRAINING: a fault is played on {name}: {taught.title}."
        event = model.event(EventKind.FAULT_INJECTED, text, actor, command.tracker_id, fault=taught.fault)
    await model.ledger.append((event,))
    loop.wake()
    return (event,)


def _simulated(drive: Drive) -> SimulatedDrive | None:
    """Return the simulated drive behind gear and actuators, None for a real one."""
    while isinstance(drive, CorrectedDrive | TransmittedDrive):
        drive = drive.inner
    return drive if isinstance(drive, SimulatedDrive) else None
