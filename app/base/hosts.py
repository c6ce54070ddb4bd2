"""Host names and addresses that people type: one check for drives, stations, brokers and servers."""

import re
from ipaddress import ip_address

from app.base.message import N_, Message, join, say

LONGEST = 253
LONGEST_SHOWN = 60
LABEL = re.compile(r"(?!-)[A-Za-z0-9_-]{1,63}(?<!-)")
DIGITS_AND_DOTS = re.compile(r"[0-9.]+")

ADVICE = N_("Enter the host only, such as plc-1.local or 192.168.0.20.")


def host_fault(host: str) -> Message | None:
    """Return why this can be no host, None if it can be one; whether it is there is not looked at."""
    if _is_address(host) or _is_name(host):
        return None
    shown = host[:LONGEST_SHOWN].encode("unicode_escape").decode("ascii")
    wrong = say("'{shown}' is not a valid host name or address.", shown=shown)
    return join(" ", (wrong, ADVICE))


def checked_host(host: str) -> str:
    """Return the host as it is, or raise `ValueError` with a sentence."""
    fault = host_fault(host)
    if fault is not None:
        raise ValueError(fault)
    return host


def _is_address(host: str) -> bool:
    """Return whether this is an IPv4 or IPv6 address, the latter with or without its interface."""
    address, percent, interface = host.partition("%")
    try:
        ip_address(address)
    except ValueError:
        return False
    return not percent or (":" in address and LABEL.fullmatch(interface) is not None)


def _is_name(host: str) -> bool:
    """Return whether this has the form of a name; digits and dots alone are an address that was mistyped."""
    labels = host.removesuffix(".").split(".")
    well_formed = len(host) <= LONGEST and all(LABEL.fullmatch(label) for label in labels)
    return well_formed and DIGITS_AND_DOTS.fullmatch(host) is None
