"""Ports for the servers of tests: none is given twice, and workers that run side by side have their own."""

import os
import random
import socket
from contextlib import suppress

FIRST, END = 20_000, 32_000
"""Below the range from which the system takes ports of outgoing connections."""
GIVEN: set[int] = set()


def free_port() -> int:
    """Return a port that nobody uses, and that no other test is given before its server listens there."""
    worker, workers = _worker()
    while True:
        port = random.randrange(FIRST + worker, END, workers)
        with socket.socket() as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            if port not in GIVEN:
                GIVEN.add(port)
                return port


def _worker() -> tuple[int, int]:
    """Return the number of this worker, and how many there are."""
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    return int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % workers, workers
