"""Help in place: what a page is for, what can go wrong there, its picture, and where the guide says more."""

import re
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Help:
    """The help of one page; `picture` names a drawing of `_help_pictures.html`, `guide` an anchor."""

    title: str
    purpose: str
    picture: str
    wrong: tuple[str, ...]
    guide: str


STEP = r"/trackers/[^/]+/commissioning/"
TRACKER = r"/trackers/[^/]+"

PAGES: tuple[tuple[str, Help], ...] = (
    (
        STEP + "location",
        Help(
            "Location",
            "The controller calculates the sun's position from the latitude and longitude of the "
            "site. An accuracy of one hundredth of a degree, about one kilometer, is sufficient.",
            "globe",
            (
                "A missing minus sign, or W instead of E, puts the site on the other side of the "
                "Earth: check the cross on the map and today's sunrise.",
                "Swapped numbers: latitude is how far north or south, longitude how far east or west.",
                "Changing the location later means that later steps must be confirmed again.",
            ),
            "1-location",
        ),
    ),
    (
        STEP + "clock",
        Help(
            "Clock",
            "The sun moves by one degree in four minutes. A clock error of one minute causes a "
            "pointing error of a quarter of a degree.",
            "shadow",
            (
                (
                    "The time is correct but the time zone is wrong: the shadow direction is then off "
                    "by 15° per hour."
                ),
                "A tablet's own clock may also be wrong: compare it with a phone.",
                "Without NTP, the clock drifts; repeat this step at every visit.",
            ),
            "2-clock",
        ),
    ),
    (
        STEP + "homing",
        Help(
            "Homing",
            "The drive measures all angles from the home position: panel vertical, facing true north.",
            "north",
            (
                (
                    "A compass shows magnetic north, which can be off by 10° or more; the sun check "
                    "detects this error."
                ),
                "The panel turns the wrong way: run the drive tests before you set the home position.",
                (
                    "A hold-to-run button works only while it is held. A connection that is too slow "
                    "ends the motion automatically."
                ),
            ),
            "3-homing",
        ),
    ),
    (
        STEP + "mode(/orientation)?",
        Help(
            "Mode",
            "What the tracker does from sunrise to sunset: follow the sun with both axes or with "
            "one axis, or hold a fixed angle.",
            "modes",
            (
                "An angle beyond the soft limits is refused; the limits are on the Settings page.",
                "Go moves the panel: keep everyone clear of it.",
                "The step is done only when the panel is in position.",
            ),
            "4-mode",
        ),
    ),
    (
        STEP + "run",
        Help(
            "Run",
            (
                "All previous steps are checked again. Then start tracking, or show the tracking "
                "movement of any day at higher speed."
            ),
            "run",
            (
                "A drive that has lost power since homing is not homed: the page returns you to step 3.",
                "At night, the tracker holds until sunrise; this is not a fault.",
                "STOP ends the motion immediately. STOP is not an emergency stop.",
            ),
            "5-run",
        ),
    ),
    (
        TRACKER + "/settings",
        Help(
            "Settings",
            "Travel limits and speeds of the axes, pointing tolerance, and park position.",
            "limits",
            (
                "Soft limits beyond the mechanical travel: the axis runs into its limit switch.",
                "A speed above the capability of the drive: the axis lags and stops with a fault.",
                "Wrong value saved: Undo the last change restores the previous settings.",
            ),
            "settings-of-a-tracker",
        ),
    ),
    (
        TRACKER + "/drive",
        Help(
            "Drive",
            "The drive is reached by its profile, address, and unit ID. Testing the connection "
            "reads everything and changes nothing.",
            "wire",
            (
                "No answer: check power, cable, and address.",
                "A device that does not match this profile answers: check the unit ID and the profile.",
                "Saving another drive loses the home reference.",
            ),
            "connect-the-drive",
        ),
    ),
    (
        TRACKER + "/drive-tests",
        Help(
            "Drive tests",
            "The drive tests check the controller's settings at the tracker: direction, scale, "
            "limits, stop, and communication loss.",
            "turn",
            (
                "These motions are real. A person must watch the tracker within reach of the emergency stop.",
                "After a change of motor, gear, or drive, repeat the drive tests.",
                "A drive without its own watchdog continues to move when the controller fails.",
            ),
            "drive-tests",
        ),
    ),
    (
        TRACKER + "/mount",
        Help(
            "Mount",
            (
                "How the panel is mounted on its axes. The same sun position needs other axis angles "
                "on another mount."
            ),
            "modes",
            (
                "After a change of mount, check the home position and the limits again.",
                "Rows shade each other when the sun is low: backtracking then turns the panels flatter.",
            ),
            "the-drive",
        ),
    ),
    (
        TRACKER + "/strategy",
        Help(
            "Strategy",
            "When the panel moves: continuously, when the pointing error exceeds a deadband, or "
            "by a program of times and angles.",
            "steps",
            (
                "Steps that are too large lose energy; simulate a day before you save.",
                "A step program suits only one location and season.",
            ),
            "energy-studies",
        ),
    ),
    (
        TRACKER + "/protections",
        Help(
            "Protections",
            "Wind stow, snow stow, and low-light hold protect the tracker. Their thresholds are set here.",
            "wind",
            (
                "A protection without a sensor has no effect: the page shows this.",
                (
                    "A threshold that is too low stows the panel all day; one that is too high can "
                    "damage the panel."
                ),
                (
                    "In manual operation, with a fault, or when not homed, the tracker does not stow "
                    "automatically."
                ),
            ),
            "protections",
        ),
    ),
    (
        TRACKER + "/sun-check",
        Help(
            "Sun check",
            (
                "The sun is the most accurate reference: where a stick square to the panel casts no "
                "shadow, the panel faces the sun."
            ),
            "shadow",
            (
                "One sighting finds a large error; three or more over a day correct the pointing.",
                "The clock must be correct first.",
            ),
            "sun-check",
        ),
    ),
    (
        TRACKER + "/record",
        Help(
            "Record",
            (
                "Documents the state of the tracker: settings, drive tests, names, and dates. A "
                "signed record is kept permanently."
            ),
            "paper",
            (
                "Sign only when every step is done: open items are part of the record as well.",
                "Photos are added before signing.",
            ),
            "commissioning-record",
        ),
    ),
    (
        "/site",
        Help(
            "Site",
            "Settings shared by all trackers: weather sources, weather evaluation, and connected systems.",
            "wind",
            (
                "If the weather station is not reached, the protections have no sensor.",
                "Simulated weather is for tests: it is refused where a tracker is real.",
            ),
            "weather-evaluation",
        ),
    ),
    (
        "/site/notifications",
        Help(
            "Notifications",
            "Alarms are also sent to users who are not at a screen, by webhook or e-mail.",
            "wire",
            (
                "Send a test message after every change.",
                "A notification that cannot be sent raises an alarm.",
            ),
            "alarms",
        ),
    ),
)
_patterns = tuple((re.compile(pattern), entry) for pattern, entry in PAGES)


def help_for(path: str) -> Help | None:
    """Return the help of the page at a path, None where it needs none."""
    return next((entry for pattern, entry in _patterns if pattern.fullmatch(path)), None)
