"""Permissions, of which roles and tokens consist."""

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
