"""What can be played on a simulated tracker for training: each fault, what will be seen, and what to do."""

from dataclasses import dataclass
from enum import StrEnum

from app.tracker.axes import Axis
from app.tracker.simulated_weather import WeatherFault


class Subject(StrEnum):
    """Where a fault is played."""

    CONNECTION = "connection"
    DRIVE = "drive"
    AXES = "axes"
    SWITCHES = "switches"
    LIGHT_SENSORS = "light_sensors"
    WEATHER = "weather"


@dataclass(frozen=True, slots=True)
class Part:
    """One fault of the machine that a lesson plays; `axis` None means both, `amount` as its kind has it."""

    kind: str
    axis: Axis | None = None
    amount: float = 0.0


@dataclass(frozen=True, slots=True)
class Lesson:
    """A fault that can be played; `rows` are those of the table of faults that it shows.

    `parts` are what the simulated machine suffers; `weather` is what the site's made-up weather does, which
    acts on every tracker of the site.
    """

    fault: str
    subject: Subject
    rows: tuple[int, ...]
    title: str
    seen: str
    do: str
    parts: tuple[Part, ...] = ()
    weather: WeatherFault | None = None


_AZIMUTH, _ELEVATION = Axis.AZIMUTH, Axis.ELEVATION
_SET_ZERO = "Set the zero again in step 3, Homing."

LESSONS = (
    Lesson(
        "silence", Subject.CONNECTION, (1, 2), "Cut the cable",
        "Within a second: no contact, the last angle with its age, tracking waits.",
        "End the fault, then press Start tracking.", (Part("silence"),),
    ),
    Lesson(
        "late_replies", Subject.CONNECTION, (5,), "Let every reply come too late",
        "A reply that comes too late counts as none: no contact, and no late reply is taken for a newer one.",
        "End the fault, then press Start tracking. Look for what slows the network down.",
        (Part("late_replies"),),
    ),
    Lesson(
        "corrupt_replies", Subject.CONNECTION, (6,), "Damage every reply",
        "No damaged reply is believed: no contact, the last angle with its age.",
        "End the fault, then press Start tracking. Check cable, shield and termination.",
        (Part("corrupt_replies"),),
    ),
    Lesson(
        "ignored_writes", Subject.CONNECTION, (7,), "Let the drive ignore its commands",
        "Move: the drive is said not to have taken the command, and that counts as no contact.",
        "End the fault, then start again what was interrupted.", (Part("ignored_writes"),),
    ),
    Lesson(
        "power_loss", Subject.DRIVE, (3, 22), "Take the drive's power",
        "The drive has restarted and its zero is not trusted.", _SET_ZERO, (Part("power_loss"),),
    ),
    Lesson(
        "drive_fault", Subject.DRIVE, (21,), "Report drive fault 7",
        "Both axes stop, the fault stays, and the zero is not trusted.",
        "Clear the fault, then set the zero again.", (Part("drive_fault", None, 7.0),),
    ),
    Lesson(
        "supply", Subject.DRIVE, (), "Let the supply fall to 18 V",
        "If the machine protections watch the supply: after two seconds a fault with the voltage.",
        "End the fault, then clear it. Without limits for the supply nothing is watched: set them first.",
        (Part("supply", None, 18.0),),
    ),
    Lesson(
        "local_switch", Subject.DRIVE, (), "Turn the switch at the cabinet to local",
        "A band on every page: Local, the panel cannot move it. Everything that moves ends.",
        "End the fault, then press Start tracking.", (Part("local_switch"),),
    ),
    Lesson(
        "swapped_axes", Subject.AXES, (9,), "Swap the motor cables",
        "Move one axis: the other one turns, and the tracker stops with a fault.",
        "End the fault, clear it, and prove the direction again.", (Part("swapped_axes"),),
    ),
    Lesson(
        "frozen_position", Subject.AXES, (11,), "Freeze the azimuth counter",
        "Move: within a second the position is called frozen, and the zero is not trusted.",
        "End the fault, clear it, set the zero again.", (Part("frozen_position", _AZIMUTH),),
    ),
    Lesson(
        "wrong_direction", Subject.AXES, (12,), "Turn the azimuth motor round",
        "Move: within a second the axis is said to move opposite to its command.",
        "End the fault, clear it, set the zero again.", (Part("wrong_direction", _AZIMUTH),),
    ),
    Lesson(
        "encoder_jump", Subject.AXES, (13,), "Let the azimuth counter jump by 12.4 degrees",
        "The jump is told at once, and the zero is not trusted.", _SET_ZERO,
        (Part("encoder_jump", _AZIMUTH, 12.4),),
    ),
    Lesson(
        "stall", Subject.AXES, (14,), "Block the azimuth axis",
        "Move: after some seconds the axis does not follow.",
        "End the fault, then clear it.", (Part("stall", _AZIMUTH),),
    ),
    Lesson(
        "slip", Subject.AXES, (15,), "Let the elevation axis creep by 0.2 degrees a second",
        "The axis moves without a command; without an end it goes beyond its soft limit.",
        "End the fault before the soft limit is reached.", (Part("slip", _ELEVATION, 0.2),),
    ),
    Lesson(
        "long_stop", Subject.AXES, (16,), "Wear the azimuth brake",
        "Move fast and press Stop: the axis runs on, and is slow from then on.",
        "End the fault; three short stops make it fast again.", (Part("long_stop", _AZIMUTH),),
    ),
    Lesson(
        "upper_limit_stuck", Subject.SWITCHES, (17,), "Press the upper azimuth switch",
        "The switch is named, and which way is free: the axis moves away from it only.",
        "Move away by hand, then end the fault.", (Part("upper_limit_stuck", _AZIMUTH),),
    ),
    Lesson(
        "lower_limit_stuck", Subject.SWITCHES, (18,), "Let the lower azimuth switch stay on",
        "Move to the right: after ten degrees the switch is called stuck, and the tracker stops.",
        "End the fault, then clear it.", (Part("lower_limit_stuck", _AZIMUTH),),
    ),
    Lesson(
        "limit_dead", Subject.SWITCHES, (19,), "Let the elevation sink past a dead switch",
        "No switch stops it: two degrees beyond its soft limit it is over-travel, the zero is not trusted.",
        "End the fault, clear it, set the zero again.",
        (Part("limit_dead", _ELEVATION), Part("slip", _ELEVATION, -1.0)),
    ),
    Lesson(
        "both_limits", Subject.SWITCHES, (20,), "Press both azimuth switches at once",
        "That cannot be: a fault of the wiring, and no motion at all, not even by hand.",
        "End the fault, then clear it. Check the wiring of the switches.",
        (Part("lower_limit_stuck", _AZIMUTH), Part("upper_limit_stuck", _AZIMUTH)),
    ),
    Lesson(
        "misaligned", Subject.LIGHT_SENSORS, (), "Turn the light sensors by 1.5 degrees",
        "With the correction by light sensors on, the panel is led off by as much, within its limits.",
        "End the fault; the correction decays.", (Part("misaligned", _AZIMUTH, 1.5),),
    ),
    Lesson(
        "cloud", Subject.LIGHT_SENSORS, (), "Draw a cloud before the sun",
        "With the correction by light sensors on, it holds its last value and says that it is too dark.",
        "End the fault; the correction goes on.", (Part("cloud", None, 0.95),),
    ),
    Lesson(
        "light_sensor_stuck", Subject.LIGHT_SENSORS, (), "Let one light sensor stick at 300 W/m2",
        "With the correction by light sensors on, it pulls to one side and stops at its limit.",
        "End the fault, and look at the correction on the live page.",
        (Part("light_sensor_stuck", _AZIMUTH, 300.0),),
    ),
    Lesson(
        "high_wind", Subject.WEATHER, (), "Let a storm blow, 20 m/s with gusts",
        "A tracker in automatic is stowed after its warning; one that is not says NOT STOWED.",
        "Where it is not stowed, press Stow against wind. End the fault and wait for ten calm minutes.",
        weather=WeatherFault.HIGH_WIND,
    ),
    Lesson(
        "snow_load", Subject.WEATHER, (), "Lay 8 kg of snow on the panel",
        "After a minute a tracker in automatic tips the panel upright.",
        "End the fault: it goes on as soon as the load is off.", weather=WeatherFault.SNOW_LOAD,
    ),
    Lesson(
        "wind_impossible", Subject.WEATHER, (38,), "Let the wind sensor report no number",
        "The wind is not known; after a minute the panel is stowed as a precaution, unless set otherwise.",
        "End the fault and wait for ten calm minutes.", weather=WeatherFault.WIND_IMPOSSIBLE,
    ),
    Lesson(
        "station_silent", Subject.WEATHER, (38,), "Let the weather station fall silent",
        "Its values grow old; after five minutes they are stale and not used, and a minute later it stows.",
        "End the fault and wait for ten calm minutes.", weather=WeatherFault.STATION_SILENT,
    ),
    Lesson(
        "wind_frozen", Subject.WEATHER, (38,), "Freeze the wind sensor",
        "After ten minutes of the same value it counts as frozen, and a minute later the panel is stowed.",
        "End the fault and wait for ten calm minutes.", weather=WeatherFault.WIND_FROZEN,
    ),
    Lesson(
        "winds_disagree", Subject.WEATHER, (39,), "Add a second mast that shows much less wind",
        "Within a minute a warning names both sensors and both values; the higher one counts and stows.",
        "Compare both with the wind outside. End the fault and wait for ten calm minutes.",
        weather=WeatherFault.WINDS_DISAGREE,
    ),
    Lesson(
        "light_flickers", Subject.WEATHER, (40,), "Let the light flicker around the threshold",
        "Nothing moves and nothing rests: darkness counts only after ten minutes without a break.",
        "Nothing has to be done. End the fault.", weather=WeatherFault.LIGHT_FLICKERS,
    ),
    Lesson(
        "snow_and_wind", Subject.WEATHER, (41,), "Let it snow and blow at once",
        "The wind wins: the panel is stowed against the wind and not tipped for the snow.",
        "End the fault and wait for ten calm minutes.", weather=WeatherFault.SNOW_AND_WIND,
    ),
    Lesson(
        "not_stowed", Subject.WEATHER, (42,), "Let a storm meet a drive with a fault",
        "A red band and an alarm of priority 1: NOT STOWED, why, and what to do.",
        "End the fault, clear it, set the zero again, then press Stow against wind.",
        (Part("drive_fault", None, 7.0),), WeatherFault.HIGH_WIND,
    ),
)  # fmt: skip
"""Every row of the table of faults that a simulated tracker can show, and what else is worth knowing."""


def lesson(fault: str) -> Lesson:
    """Return the lesson of a fault, or raise `ValueError`."""
    found = next((one for one in LESSONS if one.fault == fault), None)
    if found is None:
        names = ", ".join(one.fault for one in LESSONS)
        raise ValueError(f"There is no fault {fault!r} to be played. Choose one of: {names}.")
    return found
