"""What can go wrong with a drive, so that it can be made to go wrong on purpose."""

from dataclasses import dataclass
from enum import StrEnum

from app.tracker.settings.axes import Axis


class FaultKind(StrEnum):
    """A fault that the simulated drive can be given."""

    SILENCE = "silence"
    LATE_REPLIES = "late_replies"
    CORRUPT_REPLIES = "corrupt_replies"
    IGNORED_WRITES = "ignored_writes"
    FROZEN_POSITION = "frozen_position"
    STALL = "stall"
    SLIP = "slip"
    LOWER_LIMIT_STUCK = "lower_limit_stuck"
    UPPER_LIMIT_STUCK = "upper_limit_stuck"
    ENCODER_JUMP = "encoder_jump"
    WRONG_DIRECTION = "wrong_direction"
    POWER_LOSS = "power_loss"
    DRIVE_FAULT = "drive_fault"
    MISALIGNED = "misaligned"
    CLOUD = "cloud"
    LIGHT_SENSOR_STUCK = "light_sensor_stuck"
    LOCAL_SWITCH = "local_switch"
    SWAPPED_AXES = "swapped_axes"
    LONG_STOP = "long_stop"
    LIMIT_DEAD = "limit_dead"
    SUPPLY = "supply"


LINK_FAULTS = frozenset({FaultKind.SILENCE, FaultKind.LATE_REPLIES, FaultKind.CORRUPT_REPLIES})
"""Faults of the connection, not of the machine."""

LIGHT_FAULTS = frozenset({FaultKind.MISALIGNED, FaultKind.CLOUD, FaultKind.LIGHT_SENSOR_STUCK})
"""What only photo-sensors notice."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault: `axis` None means both.

    `amount` is degrees (jump, misalignment), degrees a second (slip), a code (drive fault), the share of the
    beam that is taken (cloud), W/m2 (stuck light sensor), the share of the deceleration that is left (long
    stop, a tenth if none is given) or volts (supply).
    """

    kind: FaultKind
    axis: Axis | None = None
    amount: float = 0.0

    def hits(self, axis: Axis) -> bool:
        """Return whether an axis is concerned."""
        return self.axis is None or self.axis is axis
