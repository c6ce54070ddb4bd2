"""Tells systemd, where there is one, that the service is ready, alive or stopping."""

import os
import socket
from contextlib import suppress


def notify(state: str) -> None:
    """Send one state line such as READY=1 to the socket that systemd named, if it named one."""
    address = os.environ.get("NOTIFY_SOCKET")
    if not address:
        return
    target = "\0" + address[1:] if address.startswith("@") else address
    with suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.setblocking(False)
        sender.sendto(state.encode(), target)
