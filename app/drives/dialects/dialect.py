"""What differs between the families of axis drives: how they report and how they are told."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True)
class AxisStatus:
    """What a drive says about its axis; `fault` waits for a reset."""

    fault: bool
    enabled: bool
    moving: bool
    homed: bool
    at_lower_limit: bool = False
    at_upper_limit: bool = False
    at_origin: bool = False


class Dialect(Protocol):
    """One axis of one drive. Targets in steps, speeds in degrees a second of the axis."""

    @property
    def polled(self) -> tuple[str, ...]:
        """Return the registers of a reading, beside position, velocity and inputs."""

    def status(self, values: Mapping[str, float]) -> AxisStatus:
        """Return what the registers of a reading say; pure."""

    def moving(self, target: int, speed_dps: float) -> Mapping[str, float]:
        """Return the registers that send the axis to a position; pure."""

    def turning(self, velocity_dps: float) -> Mapping[str, float]:
        """Return the registers that turn the axis; pure."""

    async def enable(self) -> None:
        """Power the motor without moving it, or raise `DriveError`."""

    async def move(self, target: int, speed_dps: float, *, confirmed: bool) -> None:
        """Go to a position."""

    async def turn(self, velocity_dps: float) -> None:
        """Turn until told otherwise; only asked of drives with a watchdog."""

    async def halt(self) -> None:
        """Ramp down and stay powered."""

    async def home(self) -> None:
        """Begin to search the reference."""

    async def set_home(self) -> None:
        """Call the present position zero."""

    async def reset(self) -> None:
        """Clear a fault."""

    async def stop(self) -> None:
        """Ramp down, ahead of everything that waits."""


def input_flags(bits: Mapping[str, int], values: Mapping[str, float]) -> dict[str, bool]:
    """Return the switches that a reading of the digital inputs shows; none where there are no inputs."""
    if "inputs" not in values:
        return {}
    word = int(values["inputs"])
    return {
        f"at_{name}": bool(word >> bits[name] & 1)
        for name in ("lower_limit", "upper_limit", "origin")
        if name in bits
    }


def flag(bits: Mapping[str, int], name: str, word: float) -> bool:
    """Return one bit of a word by its name; false if the profile does not have it."""
    return name in bits and bool(int(word) >> bits[name] & 1)
