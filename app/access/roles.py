"""The table of who may do what: roles and what each is granted."""

from enum import StrEnum

from app.base.message import N_, Message, Word, join
from app.base.permission import Permission


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
    Permission.OPEN: N_("open this"),
    Permission.KNOWN: N_("read their own identity"),
    Permission.STOP: N_("stop motion"),
    Permission.OWN: N_("change their own account"),
    Permission.READ: N_("read this"),
    Permission.REPORT: N_("report weather"),
    Permission.SIMULATE: N_("simulate and study"),
    Permission.OPERATE: N_("move trackers"),
    Permission.CONFIGURE: N_("change the tracker and site setup"),
    Permission.ADMINISTER: N_("manage users, tokens and backups"),
}


def permissions_of(roles: frozenset[Role]) -> frozenset[Permission]:
    """Return everything that somebody with these roles may do."""
    return NOBODY.union(*(GRANTS[role] for role in roles))


def who_may(permission: Permission) -> Message:
    """Return the roles that may do this, in words, such as `operator or engineer`."""
    return join(" or ", (Word(role.value) for role, granted in GRANTS.items() if permission in granted))
