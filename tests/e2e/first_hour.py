"""What the page of the first hour says beside what its test does: why a step is there, what to look at."""

ABOUT = """# The first hour

From an empty database to tracking, a show, a replay, and a signed record, on a simulated tracker. No real
tracker moves. A test performs every step of this page on the real service, finds every button by its
label, and takes the pictures:
`HELIOPANEL_DOCS=1 pytest tests/e2e/test_first_time.py`.

Start it with `make run` in a checkout, or with `heliopanel serve` after an
[installation](../install/README.md#a-trial), and open <http://127.0.0.1:8000> on the same computer. With a
real tracker, read [wiring](../connect/wiring.md) first, and connect its drive on the page of step 3 before
you jog it.

"""

NOTES = {
    "overview": (
        "The overview shows every tracker of the site. A new site has one, with a simulated drive, "
        "and a link to the first of the five steps. The header counts the active alarms and is on every "
        "page, as is **STOP**. STOP is not an emergency stop."
    ),
    "location": (
        "Everything begins with the location: the sun's position follows from it. Type your own latitude "
        "and longitude instead of these, and choose the side of the equator and of Greenwich. Before "
        "you save, compare the map and the position of the sun now with what you see: a wrong side shows at "
        "once. *Show larger map* adds today's sunrise, noon, and sunset."
    ),
    "clock": (
        "A clock that is wrong by 4 minutes is wrong by about 1° of the sun. Where NTP keeps the "
        "computer's clock, keep it. The page shows the sky that each clock means: go outside and look."
    ),
    "homing": (
        "The drive counts from the position at which it was switched on; it has no reference to north. On a "
        "real tracker, jog with the hold-to-run buttons until the panel faces true north and is vertical, "
        "then set the home position. The simulated tracker has home switches: *Start homing* searches them. "
        "Until this step is done, only jogging and homing move the tracker."
    ),
    "mode": (
        "*Dual-axis tracking* follows the sun with both axes, and is chosen already. The other modes hold "
        "one axis or both; [strategies](../explain/strategies.md) describes when each of them moves."
    ),
    "track": (
        "*Start tracking* moves the panel to the sun and keeps it there. At night, tracking waits for "
        "sunrise, and the page says so. From now on, tracking resumes automatically after a restart of the "
        "software, as long as the home position is valid; after **STOP** it does not."
    ),
    "tracked": (
        "Blue numbers are measured, live. Next to them are the setpoints; the difference is the "
        "following error. The picture can be turned with a finger."
    ),
    "show": (
        "A show moves the tracker through any day, or a part of one, in fast motion: for visitors, "
        "for an acceptance, or to see whether the cables are long enough. The same controller "
        "follows another sun."
    ),
    "plan": (
        "Before anything moves, the page says whether the axes are fast enough for it. If they are "
        "not, one button takes the shortest duration that works."
    ),
    "replay": (
        "Every show, and every day that a tracker works, is recorded from its first sample. No tracker "
        "moves during a replay."
    ),
    "record": (
        "The commissioning record contains the users and their steps, settings, drive, home position, "
        "drive tests, and photos. A signed record has a number and never changes again; its SHA-256 shows "
        "that a copy is identical to the original."
    ),
    "asked": (
        "Drive tests and sun check were not done in this hour, so the page asks for confirmation. On a real "
        "tracker, do them first: *Drive tests* and *Sun check*."
    ),
    "end": "To begin again, end Heliopanel with Ctrl+C and remove the folder `data`. From here:",
}

NEXT = """
- [Without hardware](without-hardware.md): a drive behind a real connection, weather, and faults.
- [Home Assistant in ten minutes](home-assistant.md).
- [Connect a drive](../connect/README.md), and [install](../install/README.md) on the permanent computer.
- [The operator's guide](../operate/operators-guide.md): every page.
"""
