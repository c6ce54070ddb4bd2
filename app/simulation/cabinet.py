"""What can be wrong in the cabinet of a simulated drive: its switch, its cables, its supply."""

from app.simulation.faults import Fault, FaultKind
from app.tracker.values.motion import AxisCommand, DriveCommand

CABINET_FAULTS = frozenset({FaultKind.LOCAL_SWITCH, FaultKind.SWAPPED_AXES, FaultKind.SUPPLY})


class Cabinet:
    """The switch on remote, each motor on its own cable, and a supply that nobody measures."""

    def __init__(self) -> None:
        self.local = self.swapped = False
        self.supply_v: float | None = None

    def inject(self, fault: Fault) -> None:
        """Turn the switch to local, swap the motor cables, or let the supply have so many volts."""
        match fault.kind:
            case FaultKind.LOCAL_SWITCH:
                self.local = True
            case FaultKind.SWAPPED_AXES:
                self.swapped = True
            case _:
                self.supply_v = fault.amount

    def wired(self, command: DriveCommand) -> tuple[AxisCommand, AxisCommand]:
        """Return what reaches the motors of the azimuth and of the elevation axis."""
        if self.swapped:
            return command.elevation, command.azimuth
        return command.azimuth, command.elevation
