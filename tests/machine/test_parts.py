"""The parts of the controller service, one by one."""

import asyncio
import io
import json
import logging
import os
import signal
import socket
import stat
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Literal

import pytest

from app.base.clock import SystemClock, VirtualClock
from app.base.errors import WRONG
from app.base.logs import get_logger, set_up_logs
from app.base.settings import SettingsWrong, read_settings
from app.machine.lock import LOCK_NAME, AlreadyRunning, holder, only_instance
from app.machine.main import audit_version
from app.machine.marker import VERSION_NAME, mark_running, mark_stopped
from app.machine.supervisor import Child, Supervisor
from app.machine.systemd import notify
from app.machine.watchdog import BEAT_EVERY, DEAD_AFTER_LOOKS, EXIT_CODE, LoopWatchdog
from app.site.clock.ntp import kernel_clock
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import AuditFilter
from tests.patience import PATIENCE_S, eventually

NOW = datetime(2026, 11, 21, 9, 0, tzinfo=UTC)


def test_one_process_holds_a_data_folder(tmp_path: Path) -> None:
    assert holder(tmp_path) is None
    with only_instance(tmp_path, NOW):
        assert holder(tmp_path) == os.getpid()
        told = f"process {os.getpid()}, running since 2026-11-21"
        with pytest.raises(AlreadyRunning, match=told), only_instance(tmp_path, NOW):
            pass
    assert holder(tmp_path) is None
    assert stat.S_IMODE((tmp_path / LOCK_NAME).stat().st_mode) == 0o600
    with only_instance(tmp_path, NOW):
        assert holder(tmp_path) == os.getpid()


def test_a_life_that_did_not_end_properly_leaves_its_mark(tmp_path: Path) -> None:
    assert mark_running(tmp_path, NOW) is None
    assert mark_running(tmp_path, NOW + timedelta(hours=1)) == NOW

    mark_stopped(tmp_path)

    assert mark_running(tmp_path, NOW) is None


def test_systemd_is_told_where_it_listens(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    notify("READY=1")
    path = tmp_path / "notify"
    monkeypatch.setenv("NOTIFY_SOCKET", str(path))
    notify("READY=1")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(str(path))
        notify("READY=1")

        assert listener.recv(100) == b"READY=1"


async def test_the_kernel_is_asked_about_ntp() -> None:
    found = kernel_clock()
    assert found is None or abs(found.offset_s) <= 0.5


class Looks:
    """Takes the place of what the watchdog's thread waits for: it looks when a test says so."""

    def __init__(self) -> None:
        self._turn, self._waits = threading.Semaphore(0), threading.Semaphore(0)
        self._over = False

    def wait(self, _: float) -> bool:
        self._waits.release()
        self._turn.acquire()
        return self._over

    def set(self) -> None:
        self._over = True
        self._turn.release()

    def pass_by(self, looks: int) -> None:
        """Have it look so often; the last look is over when this returns, unless it ended the process."""
        for _ in range(looks):
            assert self._waits.acquire(timeout=PATIENCE_S), "its thread has ended"
            self._turn.release()

    def seen(self) -> None:
        """Return once it has judged what it saw last."""
        assert self._waits.acquire(timeout=PATIENCE_S), "its thread has ended"
        self._waits.release()


@dataclass
class Watched:
    """A watchdog on a virtual clock, and what has become of the process that it watches."""

    alive: bool = True
    broken: bool = False
    clock: VirtualClock = field(default_factory=lambda: VirtualClock(NOW))
    looks: Looks = field(default_factory=Looks)
    code: int | None = None
    over: threading.Event = field(default_factory=threading.Event)
    stopped: int = 0

    def end(self, code: int) -> None:
        """Take the place of the process's end."""
        self.code = code
        self.over.set()

    async def stop_drives(self) -> None:
        self.stopped += 1
        if self.broken:
            raise RuntimeError("a programming error")

    async def beats(self, times: int) -> None:
        """Let the loop turn so often."""
        for _ in range(times):
            await eventually(lambda: self.clock._sleepers)
            self.clock.advance(BEAT_EVERY)
            await eventually(lambda: self.clock._sleepers)

    async def ended(self) -> int | None:
        await asyncio.to_thread(self.over.wait, PATIENCE_S)
        return self.code


@asynccontextmanager
async def watched(**how: bool) -> AsyncIterator[Watched]:
    found = Watched(**how)
    watchdog = LoopWatchdog(
        found.clock, alive=lambda: found.alive, stop_drives=found.stop_drives, end=found.end
    )
    watchdog._over = found.looks  # type: ignore[assignment]
    watching = asyncio.create_task(watchdog.run())
    yield found
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)


@pytest.mark.parametrize("broken", [False, True], ids=["stopped", "cannot be stopped"])
async def test_a_ticker_that_died_ends_the_machine_after_a_stop_of_its_drives(broken: bool) -> None:
    async with watched(alive=False, broken=broken) as found:
        await asyncio.to_thread(found.looks.pass_by, DEAD_AFTER_LOOKS + 1)
        assert (await found.ended(), found.stopped) == (EXIT_CODE, 1)


async def test_a_loop_that_hangs_ends_the_machine() -> None:
    """Here it hangs: nothing is awaited while the thread looks."""
    async with watched() as found:
        await found.beats(3)
        found.looks.pass_by(DEAD_AFTER_LOOKS)
        found.looks.seen()
        assert found.code is None
        found.looks.pass_by(1)
        found.over.wait(PATIENCE_S)
        assert (found.code, found.stopped) == (EXIT_CODE, 0)


async def test_a_loop_that_lives_is_left_alone() -> None:
    async with watched() as found:
        for _ in range(3):
            await asyncio.to_thread(found.looks.pass_by, DEAD_AFTER_LOOKS - 1)
            await found.beats(1)
        await asyncio.to_thread(found.looks.seen)
        assert found.code is None


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the modules that the supervisor's children run."""
    (tmp_path / "dies.py").write_text("import sys; sys.exit(3)")
    (tmp_path / "wrong.py").write_text(f"import sys; sys.exit({WRONG})")
    (tmp_path / "stays.py").write_text("import time; time.sleep(60)")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return tmp_path


def waits(clock: VirtualClock, child: Child, pause: timedelta) -> bool:
    """Return whether the child has ended and sleeps now for this long."""
    asleep = any(until == clock.now() + pause for until, _ in clock._sleepers)
    return asleep and child.pause == pause


@pytest.mark.usefixtures("written")
async def test_a_child_that_dies_is_started_again_with_a_growing_pause() -> None:
    clock, child = VirtualClock(NOW), Child("dies", ("dies",))
    supervisor = Supervisor(clock, child)
    running = asyncio.create_task(supervisor.run())
    pauses = [timedelta(milliseconds=200) * 2**n for n in range(3)]
    for pause in pauses:
        await eventually(partial(waits, clock, child, pause))
        clock.advance(pause)
    await eventually(lambda: child.pause == pauses[-1] * 2)

    supervisor.stop()

    assert await running == 0


@pytest.mark.usefixtures("written")
async def test_wrong_settings_of_one_child_end_both() -> None:
    wrong, other = Child("wrong", ("wrong",)), Child("stays", ("stays",))

    assert await Supervisor(SystemClock(), wrong, other).run() == WRONG

    assert other.process is not None
    assert other.process.returncode == -signal.SIGTERM


Logged = Callable[..., io.StringIO]


@pytest.fixture
def logged() -> Iterator[Logged]:
    """What sets up the logs of a process; uvicorn's loggers are as a new process has them, and are again."""
    loggers = [logging.getLogger(name) for name in (None, "uvicorn", "uvicorn.error")]
    before = [(one, list(one.handlers), one.level, one.propagate) for one in loggers]
    for one in loggers[1:]:
        one.handlers[:], one.level, one.propagate = [], logging.NOTSET, True

    def set_up(log_format: Literal["json", "text"] = "json") -> io.StringIO:
        stream = io.StringIO()
        set_up_logs("web", log_format=log_format, log_level="info", stream=stream)
        return stream

    yield set_up
    for one, handlers, level, propagate in before:
        one.handlers[:], one.propagate = handlers, propagate
        one.setLevel(level)
    logging.getLogger("uvicorn.error").filters.clear()


def test_logs_are_json_lines_with_the_process_in_them_and_no_live_page(logged: Logged) -> None:
    stream = logged()
    get_logger().info("tick_failed", tracker="T1")
    get_logger().debug("not shown")
    servers = logging.getLogger("uvicorn.error")
    servers.info('%s - "WebSocket %s" [accepted]', "192.0.2.7:51000", "/live")
    servers.info("connection open")
    servers.info("Uvicorn running")

    lines = [json.loads(line) for line in stream.getvalue().splitlines()]

    assert [line["event"] for line in lines] == ["tick_failed", "Uvicorn running"]
    assert all(line["process"] == "web" for line in lines)
    assert lines[0]["tracker"] == "T1"


def test_tickets_in_logged_addresses_are_masked(logged: Logged) -> None:
    stream = logged()
    logging.getLogger("uvicorn.error").info(
        '%s - "WebSocket %s" 403', "192.0.2.7:51000", "/live?tracker=T1&stop_ticket=MTc5.aW&x=1"
    )
    told = json.loads(stream.getvalue())["event"]
    assert told == '192.0.2.7:51000 - "WebSocket /live?tracker=T1&stop_ticket=...&x=1" 403'


@pytest.mark.parametrize("log_format", ["json", "text"])
def test_a_traceback_tells_no_values(logged: Logged, log_format: Literal["json", "text"]) -> None:
    def fail(password: str) -> None:
        raise RuntimeError(f"a password of {len(password)} characters")

    stream = logged(log_format)
    try:
        fail("violet-" + "anvil")
    except RuntimeError:
        logging.getLogger("uvicorn.error").exception("Exception in ASGI application")
    assert "a password of 12 characters" in stream.getvalue()
    assert "violet-anvil" not in stream.getvalue()


def test_settings_come_from_the_environment_before_the_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "settings.toml"
    file.write_text("HELIOPANEL_PORT = 9001\ntick_ms = 50\n")
    monkeypatch.setenv("HELIOPANEL_CONFIG", str(file))
    assert (read_settings().port, read_settings().tick_ms) == (9001, 50)

    monkeypatch.setenv("HELIOPANEL_PORT", "9002")
    assert read_settings().port == 9002

    file.write_text("colour = 1\n")
    with pytest.raises(SettingsWrong, match="HELIOPANEL_COLOUR"):
        read_settings()


WORKED_THEN_WRONG = f"""
from app.machine.supervised import tell_ready
tell_ready()
tell_ready()
raise SystemExit({WRONG})
"""
SLOW_THEN_WRONG = f"""
import sys, time
from pathlib import Path
Path(sys.argv[1], "begun").touch()
while not Path(sys.argv[1], "go").exists():
    time.sleep(0.01)
raise SystemExit({WRONG})
"""


async def test_settings_that_worked_once_and_do_not_any_more_end_nobody_else(written: Path) -> None:
    (written / "later.py").write_text(WORKED_THEN_WRONG)
    clock, child, other = VirtualClock(NOW), Child("later", ("later",)), Child("stays", ("stays",))
    supervisor = Supervisor(clock, child, other)
    running = asyncio.create_task(supervisor.run())
    await eventually(partial(waits, clock, child, timedelta(milliseconds=200)))
    (written / "later.py").write_text(f"raise SystemExit({WRONG})")
    clock.advance(timedelta(milliseconds=200))
    await eventually(partial(waits, clock, child, timedelta(milliseconds=400)))

    assert other.process is not None
    assert other.process.returncode is None
    supervisor.stop()
    assert await running == 0


async def test_who_took_long_to_say_that_settings_are_wrong_is_not_asked_again(written: Path) -> None:
    (written / "slow.py").write_text(SLOW_THEN_WRONG)
    clock, slow = VirtualClock(NOW), Child("slow", ("slow", str(written)))
    running = asyncio.create_task(Supervisor(clock, slow).run())
    await eventually((written / "begun").exists)
    clock.advance(timedelta(minutes=1))
    (written / "go").touch()

    assert await running == WRONG


@pytest.mark.parametrize("noted_by_a_file", [False, True])
def test_another_version_is_in_the_audit_from_its_first_start(tmp_path: Path, noted_by_a_file: bool) -> None:
    url = f"sqlite:///{tmp_path}/heliopanel.db"
    upgrade(url)
    if noted_by_a_file:
        (tmp_path / VERSION_NAME).write_text("1.2.0")
    writer = open_writer(url)
    for version in ("1.2.0", "1.2.0", "1.3.0"):
        audit_version(tmp_path, writer, version, NOW)
        assert writer.software() == version
    found = writer.audit(AuditFilter())
    writer.close()
    assert [(one.entry.action, json.loads(one.entry.given)) for one in found] == [
        ("change_version", {"before": "1.2.0", "after": "1.3.0"})
    ]
