"""What controller service and panel ask of the system: to be told when to end, and to be punctual."""

import asyncio
import os
import signal
import sys

from app.base.logs import get_logger
from app.base.settings import Settings

FIFO_PRIORITY = 10
PANEL_PRIORITY = 3
"""Below the controller's: no page and no client delays a tick."""
SWITCH_EVERY_S = 0.0005
"""So long a thread keeps the interpreter while the loop waits for it; ten times as long is usual."""

log = get_logger()


def on_signals() -> asyncio.Event:
    """Return what is set once this process is told to end."""
    stopped = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, stopped.set)
    return stopped


def raise_priority(settings: Settings) -> None:
    """Have the loop wait for no other thread for long, and ask for real-time scheduling of all of them.

    The thread that writes needs it too: while it holds the interpreter the loop waits, and other programs
    must not make both wait. Without real-time scheduling the machine still runs.
    """
    sys.setswitchinterval(SWITCH_EVERY_S)
    _ask(settings, os.SCHED_FIFO, FIFO_PRIORITY)


def raise_priority_of_panel(settings: Settings) -> None:
    """Ask for real-time scheduling of the panel's loop alone: it passes heartbeats and stops on.

    What it starts (hashes of passwords, studies, documents) shares the processors as any other program.
    """
    _ask(settings, os.SCHED_RR | os.SCHED_RESET_ON_FORK, PANEL_PRIORITY)


def _ask(settings: Settings, policy: int, priority: int) -> None:
    if not settings.real_time:
        return
    try:
        os.sched_setscheduler(0, policy, os.sched_param(priority))
    except OSError as error:
        log.info("no_real_time_scheduling", reason=error.strerror)
