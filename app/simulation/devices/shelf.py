"""Which simulated device answers to which profile, and under which unit ids."""

from collections.abc import Callable, Mapping
from typing import assert_never

from app.base.clock import Clock
from app.drives.profile import Adapter, Profile
from app.modbus.server import Device
from app.simulation.devices.axis_device import AxisDevice
from app.simulation.devices.kinco import KincoDrive
from app.simulation.devices.leadshine import LeadshineDrive
from app.simulation.devices.oriental import OrientalDrive
from app.simulation.devices.sunspec import SunSpecTracker
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated_machine import SimulatedMachine
from app.tracker.settings.axes import Axis


def devices(
    profile: Profile, machine: SimulatedMachine, clock: Clock, unit: int, gear_ratio: float = 1.0
) -> Mapping[int, Device]:
    """Return the devices that a tracker with this profile has, by unit id.

    Drives of one axis are two: azimuth at `unit`, elevation at the next.
    """
    match profile.adapter:
        case Adapter.PLC:
            return {unit: SimulatedPlc(profile, machine, clock)}
        case Adapter.SUNSPEC:
            return {unit: SunSpecTracker(machine, clock)}
        case Adapter.CIA402:
            return _pair(KincoDrive, profile, machine, clock, unit, gear_ratio)
        case Adapter.PR:
            return _pair(LeadshineDrive, profile, machine, clock, unit, gear_ratio)
        case Adapter.DIRECT:
            return _pair(OrientalDrive, profile, machine, clock, unit, gear_ratio)
        case _ as never:
            assert_never(never)


def shelf(
    profile: Profile, machines: Mapping[int, SimulatedMachine], clock: Clock, gear_ratio: float = 1.0
) -> Mapping[int, Device]:
    """Return the devices of several trackers by unit id, or raise `ValueError` if two have the same."""
    found: dict[int, Device] = {}
    for unit, machine in machines.items():
        own = devices(profile, machine, clock, unit, gear_ratio)
        both = found.keys() & own.keys()
        if both:
            raise ValueError(
                f"Unit {min(both)} is given twice: with profile {profile.name} each tracker takes "
                f"{len(own)} unit ids: give the first of each, such as {unit - 1} and {unit - 1 + len(own)}."
            )
        found |= own
    return found


def _pair(
    device: Callable[[SimulatedMachine, Axis, Clock, float], AxisDevice],
    profile: Profile,
    machine: SimulatedMachine,
    clock: Clock,
    unit: int,
    gear_ratio: float,
) -> Mapping[int, Device]:
    steps_per_deg = profile.steps_per_revolution * gear_ratio / 360.0
    return {
        unit: device(machine, Axis.AZIMUTH, clock, steps_per_deg),
        unit + 1: device(machine, Axis.ELEVATION, clock, steps_per_deg),
    }
