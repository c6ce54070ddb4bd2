"""What people at the machine forbid: locks, the switch at the cabinet, service mode. None: nothing."""

from app.tracker.config import TrackerConfig
from app.tracker.controller_state import ControllerState
from app.tracker.memory import TrackerMemory
from app.tracker.reason import Reason


def unlocked(mind: ControllerState) -> Reason | None:
    """Return that somebody works on the machine."""
    lock = mind.memory.lock
    if lock is None:
        return None
    why = f" ({lock.reason})" if lock.reason else ""
    return Reason(
        "maintenance_inhibit",
        f"{mind.config.name} has a maintenance inhibit set by {lock.name}{why}.",
        f"Ask {lock.name}; the maintenance inhibit is released on the tracker's page.",
    )


def settings_open(mind: ControllerState) -> Reason | None:
    """Return that the settings are locked as they were commissioned."""
    return locked_settings(mind.config, mind.memory)


def locked_settings(config: TrackerConfig, memory: TrackerMemory) -> Reason | None:
    """Return that a tracker's settings are locked, by whom, and who may unlock them."""
    lock = memory.settings_lock
    if lock is None:
        return None
    return Reason(
        "settings_locked",
        f"The settings of {config.name} were locked by {lock.by} on {lock.at:%Y-%m-%d}.",
        "An engineer unlocks them on the tracker's settings page, with a reason.",
    )


def locked(mind: ControllerState) -> Reason | None:
    """Return that there is no lock to release."""
    if mind.memory.lock is not None:
        return None
    return Reason("not_locked", f"{mind.config.name} has no maintenance inhibit.", "No action is needed.")


def remote(mind: ControllerState) -> Reason | None:
    """Return that the switch at the cabinet is on local: nothing here moves the machine."""
    if mind.feedback is None or not mind.feedback.local:
        return None
    return Reason(
        "local",
        f"The switch at the cabinet of {mind.config.name} is on local.",
        "Turn the switch at the cabinet to remote. Until then, the tracker is operated from the cabinet.",
    )


def served(mind: ControllerState) -> Reason | None:
    """Return that nobody serves the machine, so that service mode cannot be left or confirmed."""
    if mind.memory.service is not None:
        return None
    return Reason(
        "not_in_service", f"{mind.config.name} is not in service mode.", "Begin service mode first."
    )


def unserved(mind: ControllerState) -> Reason | None:
    """Return that somebody serves the machine: nothing else than slow hand motion."""
    service = mind.memory.service
    if service is None:
        return None
    return Reason(
        "in_service",
        f"{mind.config.name} was put in service mode by {service.name}.",
        "End service mode on the tracker's page first.",
    )


def cleared(mind: ControllerState) -> Reason | None:
    """Return that in service mode nobody has said of late that the area is clear."""
    confirmed_now = mind.clear_until is not None and mind.now < mind.clear_until
    if mind.memory.service is None or confirmed_now:
        return None
    return Reason(
        "area_not_clear",
        f"{mind.config.name} is in service mode, and the area is not confirmed clear.",
        "Check that no person is in the range of the panel, then press Confirm area clear.",
    )
