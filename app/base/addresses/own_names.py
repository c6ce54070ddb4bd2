"""The names and addresses of this computer: what a certificate is made for and a network is told."""

import socket
from contextlib import suppress

ALWAYS = ("heliopanel.local", "localhost", "127.0.0.1", "::1")
ELSEWHERE = ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1"))
"""Addresses of RFC 5737 and RFC 3849 that nobody has; connecting a datagram socket sends nothing."""


def own_names() -> tuple[str, ...]:
    """Return the names and addresses by which this computer may be called."""
    name = socket.gethostname()
    try:
        addresses = [str(found[4][0]).partition("%")[0] for found in socket.getaddrinfo(name, None)]
    except (OSError, UnicodeError):
        addresses = []  # the name is unknown, or no name: a part of it is longer than 63 characters
    short = name.partition(".")[0]
    return tuple(dict.fromkeys((*ALWAYS, name, f"{short}.local", *addresses, *_outward())))


def _outward() -> list[str]:
    """Return the addresses from which this computer reaches others; a host file may name only loopback."""
    found = []
    for family, elsewhere in ELSEWHERE:
        with socket.socket(family, socket.SOCK_DGRAM) as probe, suppress(OSError):
            probe.connect((elsewhere, 9))
            found.append(str(probe.getsockname()[0]))
    return found
