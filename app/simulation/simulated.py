"""A tracker that is not there: two axes whose position is a function of time. It has no task."""

from datetime import datetime

from app.base.message import N_
from app.modbus.errors import DriveError, DriveSilent
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.values.motion import DriveCapabilities, DriveCommand, Feedback


class SimulatedDrive(SimulatedMachine):
    """Both axes of a simulated tracker, with switches, faults on demand, watchdog and position memory.

    Where the panel really points is `true_orientation`. A drive that does not know its zero reads that
    plus an offset of 90 degrees in azimuth and 30 in elevation. With `watchdog=None` there is no watchdog:
    a simulation whose ticks are longer than its time-out needs that. `memory` keeps position, zero and boot
    count. A drive with power of its own goes on where it came to rest; one without has lost its zero if the
    program ended in mid-motion without `close`.
    Homing goes on while `Halt` is written; motion, `stop`, a fault or the watchdog end it.
    """

    @property
    def answers_at_once(self) -> bool:
        """Return that nothing here waits."""
        return True

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what the simulated tracker can do: everything."""
        return DriveCapabilities(
            automatic_homing=True,
            watchdog_s=self._watchdog_s,
            settable_clock=True,
            limit_switches=True,
            description=N_("Simulated tracker inside Heliopanel; no real tracker moves."),
            verified=True,
        )

    async def read(self) -> Feedback:
        """Return the reading of this instant, or raise `DriveSilent` while the connection is faulty."""
        self._check_link()
        return self.observe()

    async def write(self, command: DriveCommand) -> None:
        """Make the axes do this from now on, or raise `DriveError` while a fault keeps it from that."""
        self._check_link()
        if self._ignores_writes and command != self._command:
            raise DriveError(
                N_("The simulated drive did not accept the command. End the injected fault to continue.")
            )
        self.obey(command)

    async def stop(self) -> None:
        """Ramp both axes down now and end homing, or raise `DriveSilent` while the connection is faulty."""
        self._check_link()
        self.halt()

    async def set_clock(self, at: datetime) -> None:
        """Set the drive's own clock."""
        self.set_wall_clock(at)

    async def close(self) -> None:
        """Stop the axes; the position memory says where they come to rest."""
        self.remember_rest()

    def _check_link(self) -> None:
        if self._link_fault is not None:
            raise DriveSilent(
                N_(
                    "The simulated drive does not answer: a communication fault is injected. End the "
                    "injected fault to continue."
                )
            )
