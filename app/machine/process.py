"""What the controller service asks of the system: to be told when to end, and to be punctual."""

import asyncio
import os
import signal

import structlog

FIFO_PRIORITY = 10

log = structlog.get_logger(__name__)


def on_signals() -> asyncio.Event:
    """Return what is set once this process is told to end."""
    stopped = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, stopped.set)
    return stopped


def raise_priority() -> None:
    """Ask for real-time scheduling of this thread and those it starts; without it the machine still runs.

    The thread that writes needs it too: while it holds the interpreter the loop waits, and other programs
    must not make both wait.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))
    except OSError as error:
        log.info("no_real_time_scheduling", reason=error.strerror)
