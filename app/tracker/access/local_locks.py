"""What people at the machine forbid: locks, the switch at the cabinet, service mode. None: nothing."""

from app.base.message import N_, say, with_format
from app.tracker.memory.memory import TrackerMemory
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.controller_state import ControllerState
from app.tracker.values.reason import Reason


def unlocked(state: ControllerState) -> Reason | None:
    """Return that somebody works on the machine."""
    lock = state.memory.lock
    if lock is None:
        return None
    why = f" ({lock.reason})" if lock.reason else ""
    return Reason(
        "maintenance_inhibit",
        say(
            "{name} has a maintenance inhibit set by {name2}{why}.",
            name=state.config.name,
            name2=lock.name,
            why=why,
        ),
        say("Ask {name}; the maintenance inhibit is released on the tracker's page.", name=lock.name),
    )


def settings_open(state: ControllerState) -> Reason | None:
    """Return that the settings are locked as they were commissioned."""
    return locked_settings(state.config, state.memory)


def locked_settings(config: TrackerConfig, memory: TrackerMemory) -> Reason | None:
    """Return that a tracker's settings are locked, by whom, and who may unlock them."""
    lock = memory.settings_lock
    if lock is None:
        return None
    return Reason(
        "settings_locked",
        say(
            "The settings of {name} were locked by {by} on {at}.",
            name=config.name,
            by=lock.by,
            at=with_format(lock.at, "%Y-%m-%d"),
        ),
        N_("An engineer unlocks them on the tracker's settings page, with a reason."),
    )


def locked(state: ControllerState) -> Reason | None:
    """Return that there is no lock to release."""
    if state.memory.lock is not None:
        return None
    return Reason(
        "not_locked",
        say("{name} has no maintenance inhibit.", name=state.config.name),
        N_("No action is needed."),
    )


def remote(state: ControllerState) -> Reason | None:
    """Return that the switch at the cabinet is on local: nothing here moves the machine."""
    if state.feedback is None or not state.feedback.local:
        return None
    return Reason(
        "local",
        say("The switch at the cabinet of {name} is on local.", name=state.config.name),
        N_("Turn the switch at the cabinet to remote. Until then, the tracker is operated from the cabinet."),
    )


def served(state: ControllerState) -> Reason | None:
    """Return that nobody serves the machine, so that service mode cannot be left or confirmed."""
    if state.memory.service is not None:
        return None
    return Reason(
        "not_in_service",
        say("{name} is not in service mode.", name=state.config.name),
        N_("Begin service mode first."),
    )


def unserved(state: ControllerState) -> Reason | None:
    """Return that somebody serves the machine: nothing else than slow hand motion."""
    service = state.memory.service
    if service is None:
        return None
    return Reason(
        "in_service",
        say("{name} was put in service mode by {name2}.", name=state.config.name, name2=service.name),
        N_("End service mode on the tracker's page first."),
    )


def cleared(state: ControllerState) -> Reason | None:
    """Return that in service mode nobody has said of late that the area is clear."""
    confirmed_now = state.clear_until is not None and state.now < state.clear_until
    if state.memory.service is None or confirmed_now:
        return None
    return Reason(
        "area_not_clear",
        say("{name} is in service mode, and the area is not confirmed clear.", name=state.config.name),
        N_("Check that no person is in the range of the panel, then press Confirm area clear."),
    )
