"""Runs machine and panel as two processes and starts either again when it dies.

It lives as long as they do and does little: it loads next to nothing besides the standard library.
"""

import asyncio
import os
import signal
import sys
from dataclasses import dataclass
from datetime import timedelta
from typing import NoReturn

from app.base.clock import Clock, SystemClock
from app.base.errors import WRONG
from app.base.logs import get_logger, set_up_logs
from app.base.own import own_process
from app.machine.supervised import READY, SUPERVISED

FIRST_PAUSE = timedelta(milliseconds=200)
LONGEST_PAUSE = timedelta(seconds=5)
LIVED_LONG = timedelta(seconds=10)
GIVE_UP_AFTER_S = 8.0

log = get_logger()


@dataclass(slots=True)
class Child:
    """One of the two processes: its name in the log and the module that it runs."""

    name: str
    module: tuple[str, ...]
    process: asyncio.subprocess.Process | None = None
    pause: timedelta = FIRST_PAUSE
    has_worked: bool = False

    async def live(self) -> int:
        """Start it, wait for its end and return the exit code.

        It has a session of its own: the terminal's signals reach it only through the supervisor.
        """
        command = (*own_process(self.module[0]), *self.module[1:], f"{SUPERVISED}{os.getpid()}")
        heard, telling = os.pipe()
        with os.fdopen(heard, "rb", buffering=0) as pipe:
            os.set_blocking(heard, False)
            try:
                environment = os.environ | {READY: str(telling)}
                self.process = await asyncio.create_subprocess_exec(
                    *command, start_new_session=True, pass_fds=(telling,), env=environment
                )
            finally:
                os.close(telling)
            log.info("child_started", child=self.name, process_id=self.process.pid)
            code = await self.process.wait()
            self.has_worked |= bool(pipe.read(1))
        return code

    def signal(self, number: signal.Signals) -> None:
        """Send it a signal if it runs."""
        if self.process is not None and self.process.returncode is None:
            self.process.send_signal(number)


class Supervisor:
    """Keeps children alive until it is told to stop or one of them says that its settings are wrong.

    Settings of a child that has worked with them were right: its address is gone, say. It is tried again, and
    the other child goes on.
    """

    def __init__(self, clock: Clock, *children: Child) -> None:
        self._clock = clock
        self._children = children
        self._stopping = asyncio.Event()

    def stop(self) -> None:
        """End every child, then return from `run`."""
        self._stopping.set()

    async def run(self) -> int:
        """Return the exit code: 0 after `stop`, a child's own if its settings are wrong."""
        keeping = [asyncio.create_task(self._keep(child)) for child in self._children]
        stopping = asyncio.create_task(self._stopping.wait())
        done, _ = await asyncio.wait({*keeping, stopping}, return_when=asyncio.FIRST_COMPLETED)
        for task in (*keeping, stopping):
            task.cancel()
        await asyncio.gather(*keeping, stopping, return_exceptions=True)
        await asyncio.gather(*(self._end(child) for child in self._children))
        return next((int(task.result()) for task in done if task is not stopping), 0)

    async def _keep(self, child: Child) -> int:
        while True:
            began = self._clock.now()
            code = await child.live()
            if self._clock.now() - began >= LIVED_LONG:
                child.pause = FIRST_PAUSE
            if code == WRONG and not child.has_worked:
                return code
            log.error("child_died", child=child.name, code=code, again_in_s=child.pause.total_seconds())
            await self._clock.sleep_until(self._clock.now() + child.pause)
            child.pause = min(child.pause * 2, LONGEST_PAUSE)

    async def _end(self, child: Child) -> None:
        if child.process is None:
            return
        child.signal(signal.SIGTERM)
        try:
            async with asyncio.timeout(GIVE_UP_AFTER_S):
                await child.process.wait()
        except TimeoutError:
            log.error("child_killed", child=child.name)
            child.signal(signal.SIGKILL)
            await child.process.wait()


def supervise(log_format: str, log_level: str) -> NoReturn:
    """Become the supervisor, in the place of the command line and all that it loaded."""
    sys.stdout.flush()
    command = (*own_process("app.machine.supervisor"), log_format, log_level)
    os.execv(command[0], command)  # noqa: S606 - our own module, and no shell


async def _supervise() -> int:
    supervisor = Supervisor(
        SystemClock(), Child("controller", ("app.machine",)), Child("web", ("app.panel",))
    )
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, supervisor.stop)
    return await supervisor.run()


def main() -> int:
    """Run both processes until SIGTERM or SIGINT and return the exit code."""
    log_format, log_level = sys.argv[1:]
    set_up_logs("supervisor", log_format="json" if log_format == "json" else "text", log_level=log_level)
    return asyncio.run(_supervise())


if __name__ == "__main__":
    sys.exit(main())
