"""The state machine of CiA 402 drives, as a decoder, a table of transitions and one object a mode.

Source: CiA 402-2 (IEC 61800-7-201), statusword 6041h, controlword 6040h, modes of operation 6060h.
"""

from dataclasses import dataclass
from enum import StrEnum

TARGET_REACHED = 1 << 10
INTERNAL_LIMIT = 1 << 11
HALT_BIT = 0x0100
SHUTDOWN, SWITCH_ON, ENABLE, DISABLE_VOLTAGE = 0x06, 0x07, 0x0F, 0x00
HALTED = ENABLE | HALT_BIT
FAULT_RESET = 0x80
CHANGE_AT_ONCE, START = 0x20, 0x10
MOST_TRANSITIONS = 4


class State(StrEnum):
    """What a CiA 402 drive is ready for."""

    NOT_READY = "not ready to switch on"
    SWITCH_ON_DISABLED = "switch-on disabled"
    READY = "ready to switch on"
    SWITCHED_ON = "switched on"
    ENABLED = "operation enabled"
    QUICK_STOP = "quick stop active"
    FAULT_REACTION = "fault reaction active"
    FAULT = "fault"


STATES = (
    (0x4F, 0x00, State.NOT_READY),
    (0x4F, 0x40, State.SWITCH_ON_DISABLED),
    (0x6F, 0x21, State.READY),
    (0x6F, 0x23, State.SWITCHED_ON),
    (0x6F, 0x27, State.ENABLED),
    (0x6F, 0x07, State.QUICK_STOP),
    (0x4F, 0x0F, State.FAULT_REACTION),
    (0x4F, 0x08, State.FAULT),
)
"""Mask, value and state, as the standard lists them."""

TOWARDS_ENABLED = {
    State.SWITCH_ON_DISABLED: SHUTDOWN,
    State.READY: SWITCH_ON,
    State.SWITCHED_ON: HALTED,
    State.QUICK_STOP: DISABLE_VOLTAGE,
}
"""The controlword that leads one state nearer to operation enabled; the last one enables without motion."""

FAULTY = (State.FAULT, State.FAULT_REACTION)


def state_of(statusword: int) -> State:
    """Return the state that a statusword says."""
    for mask, value, state in STATES:
        if statusword & mask == value:
            return state
    return State.NOT_READY


@dataclass(frozen=True, slots=True)
class ProfilePosition:
    """Go to a target; a new one takes effect at once. Steps, and steps a second in the drive's unit."""

    target: int
    speed: float

    number = 1
    controlwords = (ENABLE | CHANGE_AT_ONCE, ENABLE | CHANGE_AT_ONCE | START)

    def values(self) -> dict[str, float]:
        """Return the registers that this mode needs."""
        return {"profile_velocity": self.speed, "target_position": self.target}


@dataclass(frozen=True, slots=True)
class ProfileVelocity:
    """Turn at a signed speed in the drive's unit until told otherwise."""

    velocity: float

    number = 3
    controlwords = (ENABLE,)

    def values(self) -> dict[str, float]:
        """Return the registers that this mode needs."""
        return {"target_velocity": self.velocity}


@dataclass(frozen=True, slots=True)
class Homing:
    """Find the reference by one of the drive's methods."""

    method: int

    number = 6
    controlwords = (ENABLE, ENABLE | START)

    def values(self) -> dict[str, float]:
        """Return the registers that this mode needs."""
        return {"homing_method": self.method}


Mode = ProfilePosition | ProfileVelocity | Homing
