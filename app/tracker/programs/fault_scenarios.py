"""What can be played on a simulated tracker for training: each fault, what will be seen, and what to do."""

from dataclasses import dataclass
from enum import StrEnum

from app.base.message import N_, join, say
from app.tracker.settings.axes import Axis
from app.tracker.weather.simulated_weather import WeatherFault


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
_SET_ZERO = N_("Set the home position again in step 3, Homing.")

LESSONS = (
    Lesson(
        "silence", Subject.CONNECTION, (1, 2), N_("Cut the cable"),
        N_("Within a second: no communication, the last angle with its age, and tracking is interrupted."),
        N_("End the fault, then press Start tracking."), (Part("silence"),),
    ),
    Lesson(
        "late_replies", Subject.CONNECTION, (5,), N_("Delay every reply too long"),
        N_("A reply that comes too late counts as none: no communication, and no late reply is taken "
        "for a newer one."),
        N_("End the fault, then press Start tracking. Find out what slows the network down."),
        (Part("late_replies"),),
    ),
    Lesson(
        "corrupt_replies", Subject.CONNECTION, (6,), N_("Corrupt every reply"),
        N_("Corrupted replies are discarded: no communication, the last angle with its age."),
        N_("End the fault, then press Start tracking. Check cable, shield, and termination."),
        (Part("corrupt_replies"),),
    ),
    Lesson(
        "ignored_writes", Subject.CONNECTION, (7,), N_("Make the drive ignore its commands"),
        N_("Move: the drive is reported as not accepting the command, which counts as no communication."),
        N_("End the fault, then restart what was interrupted."), (Part("ignored_writes"),),
    ),
    Lesson(
        "power_loss", Subject.DRIVE, (3, 22), N_("Cut the drive's power"),
        N_("The drive has restarted, and its home reference is lost."), _SET_ZERO, (Part("power_loss"),),
    ),
    Lesson(
        "drive_fault", Subject.DRIVE, (21,), N_("Report drive fault 7"),
        N_("Both axes stop, the fault remains, and the home reference is lost."),
        N_("Reset the fault, then set the home position again."), (Part("drive_fault", None, 7.0),),
    ),
    Lesson(
        "supply", Subject.DRIVE, (), N_("Drop the supply to 18 V"),
        N_("If the supply is monitored: after two seconds, a fault with the voltage."),
        N_("End the fault, then reset it. Without supply limits there is no monitoring: "
            "set the limits first."),
        (Part("supply", None, 18.0),),
    ),
    Lesson(
        "local_switch", Subject.DRIVE, (), N_("Turn the switch at the cabinet to local"),
        N_("A band on every page: Local, Heliopanel cannot move the tracker. All motion ends."),
        N_("End the fault, then press Start tracking."), (Part("local_switch"),),
    ),
    Lesson(
        "swapped_axes", Subject.AXES, (9,), N_("Swap the motor cables"),
        N_("Move one axis: the other one turns, and the tracker stops with a fault."),
        N_("End the fault, reset it, and repeat the direction test."), (Part("swapped_axes"),),
    ),
    Lesson(
        "frozen_position", Subject.AXES, (11,), N_("Freeze the azimuth counter"),
        N_("Move: within a second the position is reported as frozen, and the home reference is lost."),
        N_("End the fault, reset it, then set the home "
            "position again."), (Part("frozen_position", _AZIMUTH),),
    ),
    Lesson(
        "wrong_direction", Subject.AXES, (12,), N_("Invert the azimuth motor direction"),
        N_("Move: within a second the axis is reported as moving opposite to its command."),
        N_("End the fault, reset it, then set the home "
            "position again."), (Part("wrong_direction", _AZIMUTH),),
    ),
    Lesson(
        "encoder_jump", Subject.AXES, (13,), N_("Make the azimuth counter jump by 12.4 degrees"),
        N_("The jump is reported at once, and the home reference is lost."), _SET_ZERO,
        (Part("encoder_jump", _AZIMUTH, 12.4),),
    ),
    Lesson(
        "stall", Subject.AXES, (14,), N_("Block the azimuth axis"),
        N_("Move: after some seconds a following error is reported."),
        N_("End the fault, then reset it."), (Part("stall", _AZIMUTH),),
    ),
    Lesson(
        "slip", Subject.AXES, (15,), N_("Move the elevation axis uncommanded at 0.2 degrees a second"),
        N_("Uncommanded motion of the axis; if it does not end, the axis passes its soft limit."),
        N_("End the fault before the soft limit is reached."), (Part("slip", _ELEVATION, 0.2),),
    ),
    Lesson(
        "long_stop", Subject.AXES, (16,), N_("Wear the azimuth brake"),
        N_("Move fast and press Stop: the axis exceeds its stopping distance, then moves at reduced speed."),
        N_("End the fault; three short stops restore the full speed."), (Part("long_stop", _AZIMUTH),),
    ),
    Lesson(
        "upper_limit_stuck", Subject.SWITCHES, (17,), N_("Press the upper azimuth switch"),
        N_("The switch is named, with the free direction: the axis moves away from the switch only."),
        N_("Jog the axis away from the switch, then end the fault."), (Part("upper_limit_stuck", _AZIMUTH),),
    ),
    Lesson(
        "lower_limit_stuck", Subject.SWITCHES, (18,), N_("Keep the lower azimuth switch on"),
        N_("Move to the right: after ten degrees the switch is reported as stuck, and the tracker stops."),
        N_("End the fault, then reset it."), (Part("lower_limit_stuck", _AZIMUTH),),
    ),
    Lesson(
        "limit_dead", Subject.SWITCHES, (19,), N_("Let the elevation axis drop past a dead switch"),
        N_("No switch stops the axis: two degrees beyond its soft limit is overtravel, and the home "
        "reference is lost."),
        N_("End the fault, reset it, then set the home position again."),
        (Part("limit_dead", _ELEVATION), Part("slip", _ELEVATION, -1.0)),
    ),
    Lesson(
        "both_limits", Subject.SWITCHES, (20,), N_("Press both azimuth switches at once"),
        N_("A wiring fault, since both cannot be on at once. All motion is blocked, including jog."),
        N_("End the fault, then reset it. Check the wiring of the switches."),
        (Part("lower_limit_stuck", _AZIMUTH), Part("upper_limit_stuck", _AZIMUTH)),
    ),
    Lesson(
        "misaligned", Subject.LIGHT_SENSORS, (), N_("Turn the light sensors by 1.5 degrees"),
        N_("With the correction by light sensors on, the panel deviates by the same angle, "
            "within its limits."),
        N_("End the fault; the correction decays."), (Part("misaligned", _AZIMUTH, 1.5),),
    ),
    Lesson(
        "cloud", Subject.LIGHT_SENSORS, (), N_("Move a cloud in front of the sun"),
        N_("With the correction by light sensors on, it holds its last value and reports low irradiance."),
        N_("End the fault; the correction continues."), (Part("cloud", None, 0.95),),
    ),
    Lesson(
        "light_sensor_stuck", Subject.LIGHT_SENSORS, (), N_("Hold one light sensor at 300 W/m2"),
        N_("With the correction by light sensors on, it pulls to one side and stops at its limit."),
        N_("End the fault, and look at the correction on the live page."),
        (Part("light_sensor_stuck", _AZIMUTH, 300.0),),
    ),
    Lesson(
        "high_wind", Subject.WEATHER, (), N_("Start a storm, 20 m/s with gusts"),
        N_("A tracker in automatic is stowed after its warning; a tracker in manual reports NOT STOWED."),
        N_("If a tracker is not stowed, press Stow panel. End the fault and wait "
            "for ten calm minutes."),
        weather=WeatherFault.HIGH_WIND,
    ),
    Lesson(
        "snow_load", Subject.WEATHER, (), N_("Put 8 kg of snow on the panel"),
        N_("After a minute, a tracker in automatic moves the panel to its snow stow."),
        N_("End the fault: tracking continues as soon as the load is off."), weather=WeatherFault.SNOW_LOAD,
    ),
    Lesson(
        "wind_impossible", Subject.WEATHER, (38,), N_("Make the wind sensor report no number"),
        N_("The wind is not known; after a minute the panel is stowed as a precaution, "
            "unless set otherwise."),
        N_("End the fault and wait for ten calm minutes."), weather=WeatherFault.WIND_IMPOSSIBLE,
    ),
    Lesson(
        "station_silent", Subject.WEATHER, (38,), N_("Stop the weather station's reports"),
        N_("The values become stale after five minutes and are not used. A minute later, the tracker stows."),
        N_("End the fault and wait for ten calm minutes."), weather=WeatherFault.STATION_SILENT,
    ),
    Lesson(
        "wind_frozen", Subject.WEATHER, (38,), N_("Freeze the wind sensor"),
        N_("After ten minutes of the same value, the sensor counts as frozen; a minute later the "
        "panel is stowed."),
        N_("End the fault and wait for ten calm minutes."), weather=WeatherFault.WIND_FROZEN,
    ),
    Lesson(
        "winds_disagree", Subject.WEATHER, (39,), N_("Add a second mast that shows much less wind"),
        N_("Within a minute a warning names both sensors and both values; the higher one counts and stows."),
        N_("Compare both with the wind outside. End the fault and wait for ten calm minutes."),
        weather=WeatherFault.WINDS_DISAGREE,
    ),
    Lesson(
        "light_flickers", Subject.WEATHER, (40,), N_("Vary the irradiance around the threshold"),
        N_("No motion and no low-light hold: low light counts only after ten uninterrupted minutes."),
        N_("No action is needed. End the fault."), weather=WeatherFault.LIGHT_FLICKERS,
    ),
    Lesson(
        "snow_and_wind", Subject.WEATHER, (41,), N_("Start snow and wind together"),
        N_("The wind has priority: the panel goes to its wind stow, not to its snow stow."),
        N_("End the fault and wait for ten calm minutes."), weather=WeatherFault.SNOW_AND_WIND,
    ),
    Lesson(
        "not_stowed", Subject.WEATHER, (42,), N_("Start a storm with a faulted drive"),
        N_("A red band and an alarm of priority 1: NOT STOWED, the reason, and what to do."),
        N_("End the fault, reset it, set the home position again, then press Stow panel."),
        (Part("drive_fault", None, 7.0),), WeatherFault.HIGH_WIND,
    ),
)  # fmt: skip
"""Every row of the table of faults that a simulated tracker can show, and what else is worth knowing."""


def lesson(fault: str) -> Lesson:
    """Return the lesson of a fault, or raise `ValueError`."""
    found = next((one for one in LESSONS if one.fault == fault), None)
    if found is None:
        names = join(", ", (one.fault for one in LESSONS))
        raise ValueError(
            say(
                "There is no fault {fault} to inject. Choose one of: {names}.", fault=repr(fault), names=names
            )
        )
    return found
