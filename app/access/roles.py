"""The table of who may do what: roles, permissions, and the permission of every kind of order."""

from enum import StrEnum


class Permission(StrEnum):
    """What a request needs; every route and every order has exactly one."""

    OPEN = "open"
    KNOWN = "known"
    STOP = "stop"
    OWN = "own"
    READ = "read"
    REPORT = "report"
    SIMULATE = "simulate"
    OPERATE = "operate"
    CONFIGURE = "configure"
    ADMINISTER = "administer"


class Role(StrEnum):
    """A bundle of permissions that a person is given; one person may have several."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    ENGINEER = "engineer"
    ADMINISTRATOR = "administrator"


NOBODY = frozenset({Permission.OPEN})
KNOWN = NOBODY | {Permission.KNOWN}
SEEING = KNOWN | {Permission.READ, Permission.STOP, Permission.OWN}
OPERATING = SEEING | {Permission.OPERATE, Permission.SIMULATE, Permission.REPORT}

GRANTS: dict[Role, frozenset[Permission]] = {
    Role.VIEWER: SEEING,
    Role.OPERATOR: OPERATING,
    Role.ENGINEER: OPERATING | {Permission.CONFIGURE},
    Role.ADMINISTRATOR: SEEING | {Permission.ADMINISTER},
}
"""An administrator has no right to move anything; he may give himself a second role, which is recorded."""

RANKS = {Role.VIEWER: 0, Role.ADMINISTRATOR: 0, Role.OPERATOR: 1, Role.ENGINEER: 2}
"""Whose word counts more at a tracker."""

DOES = {
    Permission.OPEN: "open this",
    Permission.KNOWN: "read their own identity",
    Permission.STOP: "stop motion",
    Permission.OWN: "change their own account",
    Permission.READ: "read this",
    Permission.REPORT: "report weather",
    Permission.SIMULATE: "simulate and study",
    Permission.OPERATE: "move trackers",
    Permission.CONFIGURE: "change the tracker and site setup",
    Permission.ADMINISTER: "manage users, tokens and backups",
}

ORDERS: dict[str, Permission] = {
    "stop": Permission.STOP,
    "stop_all": Permission.STOP,
    "end_jog": Permission.STOP,
    "jog": Permission.OPERATE,
    "step": Permission.OPERATE,
    "move": Permission.OPERATE,
    "park": Permission.OPERATE,
    "track": Permission.OPERATE,
    "set_mode": Permission.OPERATE,
    "stow": Permission.OPERATE,
    "resume": Permission.OPERATE,
    "set_inhibit": Permission.OPERATE,
    "release_inhibit": Permission.OPERATE,
    "inject_fault": Permission.CONFIGURE,
    "end_injected_faults": Permission.CONFIGURE,
    "begin_service_mode": Permission.CONFIGURE,
    "confirm_area_clear": Permission.CONFIGURE,
    "end_service_mode": Permission.CONFIGURE,
    "go_to_start": Permission.OPERATE,
    "run_show": Permission.OPERATE,
    "pause_show": Permission.OPERATE,
    "resume_show": Permission.OPERATE,
    "stop_show": Permission.OPERATE,
    "save_plan": Permission.OPERATE,
    "request_control": Permission.OPERATE,
    "answer_control": Permission.OPERATE,
    "release_control": Permission.OPERATE,
    "renew_control": Permission.OPERATE,
    "reset_fault": Permission.OPERATE,
    "acknowledge_alarm": Permission.OPERATE,
    "shelve_alarm": Permission.OPERATE,
    "unshelve_alarm": Permission.OPERATE,
    "set_notifications": Permission.CONFIGURE,
    "test_notification": Permission.CONFIGURE,
    "report_weather": Permission.REPORT,
    "save_recording": Permission.SIMULATE,
    "delete_recording": Permission.CONFIGURE,
    "set_home": Permission.CONFIGURE,
    "undo_home": Permission.CONFIGURE,
    "home": Permission.CONFIGURE,
    "test_direction": Permission.CONFIGURE,
    "test_scale": Permission.CONFIGURE,
    "test_stop": Permission.CONFIGURE,
    "test_communication_loss": Permission.CONFIGURE,
    "answer_direction": Permission.CONFIGURE,
    "answer_scale": Permission.CONFIGURE,
    "set_soft_limit": Permission.CONFIGURE,
    "restore_drive": Permission.CONFIGURE,
    "undo_settings": Permission.CONFIGURE,
    "undo_site_settings": Permission.CONFIGURE,
    "check_connection": Permission.CONFIGURE,
    "set_location": Permission.CONFIGURE,
    "set_horizon": Permission.CONFIGURE,
    "set_met_station": Permission.CONFIGURE,
    "simulate_weather": Permission.CONFIGURE,
    "set_weather_windows": Permission.CONFIGURE,
    "set_clock": Permission.CONFIGURE,
    "rename_site": Permission.CONFIGURE,
    "add_tracker": Permission.CONFIGURE,
    "configure_tracker": Permission.CONFIGURE,
    "remove_tracker": Permission.CONFIGURE,
    "confirm_step": Permission.CONFIGURE,
    "lock_settings": Permission.CONFIGURE,
    "unlock_settings": Permission.CONFIGURE,
    "add_record_photo": Permission.CONFIGURE,
    "remove_record_photo": Permission.CONFIGURE,
    "sign_record": Permission.CONFIGURE,
    "take_sighting": Permission.CONFIGURE,
    "apply_sightings": Permission.CONFIGURE,
}
"""What every kind of order needs; a kind that is not here is refused."""


def permissions_of(roles: frozenset[Role]) -> frozenset[Permission]:
    """Return everything that somebody with these roles may do."""
    return NOBODY.union(*(GRANTS[role] for role in roles))


def who_may(permission: Permission) -> str:
    """Return the roles that may do this, in words, such as `operator or engineer`."""
    return " or ".join(role.value for role, granted in GRANTS.items() if permission in granted)
