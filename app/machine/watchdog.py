"""A thread that sees a dead loop: it stops the drives as far as it can, and ends the process."""

import asyncio
import os
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import TimeoutError as TooLate
from datetime import timedelta
from typing import Any

from app.base.clock import Clock
from app.base.logs import get_logger
from app.machine.systemd import notify

LOOK_EVERY_S = 0.25
BEAT_EVERY = timedelta(milliseconds=100)
DEAD_AFTER_LOOKS = 4
LAST_STOP_S = 0.3
EXIT_CODE = 70

log = get_logger()


class LoopWatchdog:
    """Watches one event loop from outside.

    It counts its own looks instead of comparing clocks: a process that was frozen as a whole and goes
    on is not taken for dead.
    """

    def __init__(
        self,
        clock: Clock,
        *,
        alive: Callable[[], bool],
        stop_drives: Callable[[], Awaitable[None]],
        end: Callable[[int], Any] = os._exit,
    ) -> None:
        self._clock = clock
        self._alive = alive
        self._stop_drives = stop_drives
        self._end = end
        self._beats = 0
        self._over = threading.Event()

    async def run(self) -> None:
        """Beat for as long as the loop and its tickers live; the thread judges."""
        thread = threading.Thread(
            target=self._watch, args=(asyncio.get_running_loop(),), name="loop-watchdog", daemon=True
        )
        thread.start()
        try:
            while self._alive():
                self._beats += 1
                notify("WATCHDOG=1")
                await self._clock.sleep_until(self._clock.now() + BEAT_EVERY)
            await asyncio.Event().wait()
        finally:
            self._over.set()

    def _watch(self, loop: asyncio.AbstractEventLoop) -> None:
        seen, missed = -1, 0
        while not self._over.wait(LOOK_EVERY_S):
            missed = missed + 1 if self._beats == seen else 0
            seen = self._beats
            if missed >= DEAD_AFTER_LOOKS:
                self._give_up(loop)
                return

    def _give_up(self, loop: asyncio.AbstractEventLoop) -> None:
        log.critical("control_loop_dead", action="drives are stopped and the controller service ends")
        try:
            stopping = asyncio.run_coroutine_threadsafe(_ended(self._stop_drives), loop)
            stopping.result(LAST_STOP_S)
        except TooLate:
            log.critical("drives_not_told", action="each drive's own watchdog stops it")
        except Exception:
            log.exception("drives_not_told", action="each drive's own watchdog stops it")
        finally:
            self._end(EXIT_CODE)


async def _ended(stop_drives: Callable[[], Awaitable[None]]) -> None:
    await stop_drives()
