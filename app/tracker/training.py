"""What can be played on a simulated tracker for training: each fault, what will be seen, and what to do."""

from dataclasses import dataclass

from app.tracker.axes import Axis


@dataclass(frozen=True, slots=True)
class Lesson:
    """A fault that can be played; `row` is that of the table of faults, `amount` what it is played with."""

    fault: str
    row: int
    title: str
    seen: str
    do: str
    axis: Axis | None = Axis.AZIMUTH
    amount: float = 0.0


LESSONS = (
    Lesson(
        "silence", 1, "Cut the cable",
        "Within a second: no contact, the last angle with its age, tracking waits.",
        "End the fault, then press Start tracking.", None,
    ),
    Lesson(
        "power_loss", 22, "Take the drive's power",
        "The drive has restarted and its zero is not trusted.",
        "Set the zero again in step 3, Homing.", None,
    ),
    Lesson(
        "swapped_axes", 9, "Swap the motor cables",
        "Move one axis: the other one turns, and the tracker stops with a fault.",
        "End the fault, clear it, and prove the direction again.", None,
    ),
    Lesson(
        "frozen_position", 11, "Freeze the azimuth counter",
        "Move: within a second the position is called frozen, and the zero is not trusted.",
        "End the fault, clear it, set the zero again.",
    ),
    Lesson(
        "wrong_direction", 12, "Turn the azimuth motor round",
        "Move: within a second the axis is said to move opposite to its command.",
        "End the fault, clear it, set the zero again.",
    ),
    Lesson(
        "encoder_jump", 13, "Let the azimuth counter jump by 12.4 degrees",
        "The jump is told at once, and the zero is not trusted.",
        "Set the zero again in step 3, Homing.", Axis.AZIMUTH, 12.4,
    ),
    Lesson(
        "stall", 14, "Block the azimuth axis",
        "Move: after some seconds the axis does not follow.",
        "End the fault, then clear it.",
    ),
    Lesson(
        "slip", 15, "Let the elevation axis creep by 0.2 degrees a second",
        "The axis moves without a command; without an end it goes beyond its soft limit.",
        "End the fault before the soft limit is reached.", Axis.ELEVATION, 0.2,
    ),
    Lesson(
        "long_stop", 16, "Wear the azimuth brake",
        "Move fast and press Stop: the axis runs on, and is slow from then on.",
        "End the fault; three short stops make it fast again.",
    ),
    Lesson(
        "upper_limit_stuck", 17, "Press the upper azimuth switch",
        "The axis moves away from the switch only; after ten degrees the switch is called stuck.",
        "End the fault, then clear it.",
    ),
    Lesson(
        "drive_fault", 21, "Report drive fault 7",
        "Both axes stop, the fault stays, and the zero is not trusted.",
        "Clear the fault, then set the zero again.", None, 7.0,
    ),
    Lesson(
        "local_switch", 0, "Turn the switch at the cabinet to local",
        "Nothing here moves the tracker until the switch is turned back.",
        "End the fault, then press Start tracking.", None,
    ),
)  # fmt: skip
"""Row 0: no row of the table, but worth knowing."""


def lesson(fault: str) -> Lesson:
    """Return the lesson of a fault, or raise `ValueError`."""
    found = next((one for one in LESSONS if one.fault == fault), None)
    if found is None:
        names = ", ".join(one.fault for one in LESSONS)
        raise ValueError(f"There is no fault {fault!r} to be played. Choose one of: {names}.")
    return found
