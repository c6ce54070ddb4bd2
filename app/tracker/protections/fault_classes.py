"""Which class every latched fault belongs to; its recovery policy goes by that."""

from app.tracker.settings.mechanics import FaultClass

CLASSES: dict[str, FaultClass] = {
    "drive_lost": FaultClass.LINK,
    "drive_fault": FaultClass.DRIVE,
    "command_refused": FaultClass.DRIVE,
    "following_error": FaultClass.FOLLOWING,
    "position_frozen": FaultClass.FOLLOWING,
    "move_overdue": FaultClass.FOLLOWING,
    "wrong_direction": FaultClass.WIRING,
    "axes_swapped": FaultClass.WIRING,
    "limit_switch_wiring": FaultClass.SWITCHES,
    "limit_stuck": FaultClass.SWITCHES,
    "over_travel": FaultClass.TRAVEL,
    "supply_voltage": FaultClass.SUPPLY,
}
"""By the code of the reason; a code that is not here is left by a person alone."""
