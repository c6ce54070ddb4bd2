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
from collections.abc import AsyncIterator, Iterator
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


def test_systemd_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "notify"
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(str(path))
        monkeypatch.setenv("NOTIFY_SOCKET", str(path))
        notify("READY=1")

        assert listener.recv(100) == b"READY=1"


def test_without_systemd_nobody_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", "/nowhere/notify")
    notify("READY=1")
    monkeypatch.delenv("NOTIFY_SOCKET")
    notify("READY=1")


async def test_the_kernel_is_asked_about_ntp() -> None:
    found = kernel_clock()
    assert found is None or abs(found.offset_s) <= 0.5


class Ending:
    """Takes the place of the process's end and remembers the exit code."""

    def __init__(self) -> None:
        self.code: int | None = None
        self.ended = threading.Event()

    def __call__(self, code: int) -> None:
        self.code = code
        self.ended.set()


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
    ending: Ending = field(default_factory=Ending)
    stopped: int = 0

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
        await asyncio.to_thread(self.ending.ended.wait, PATIENCE_S)
        return self.ending.code


@asynccontextmanager
async def watched(**how: bool) -> AsyncIterator[Watched]:
    found = Watched(**how)
    watchdog = LoopWatchdog(
        found.clock, alive=lambda: found.alive, stop_drives=found.stop_drives, end=found.ending
    )
    watchdog._over = found.looks  # type: ignore[assignment]
    watching = asyncio.create_task(watchdog.run())
    yield found
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)


async def test_a_ticker_that_died_ends_the_machine_with_its_drives_stopped() -> None:
    async with watched(alive=False) as found:
        await asyncio.to_thread(found.looks.pass_by, DEAD_AFTER_LOOKS + 1)
        assert (await found.ended(), found.stopped) == (EXIT_CODE, 1)


async def test_drives_that_cannot_be_stopped_do_not_keep_a_dead_machine_alive() -> None:
    async with watched(alive=False, broken=True) as found:
        await asyncio.to_thread(found.looks.pass_by, DEAD_AFTER_LOOKS + 1)
        assert (await found.ended(), found.stopped) == (EXIT_CODE, 1)


async def test_a_loop_that_hangs_ends_the_machine() -> None:
    """Here it hangs: nothing is awaited while the thread looks."""
    async with watched() as found:
        await found.beats(3)
        found.looks.pass_by(DEAD_AFTER_LOOKS)
        found.looks.seen()
        assert found.ending.code is None
        found.looks.pass_by(1)
        found.ending.ended.wait(PATIENCE_S)
        assert (found.ending.code, found.stopped) == (EXIT_CODE, 0)


async def test_a_loop_that_lives_is_left_alone() -> None:
    async with watched() as found:
        for _ in range(3):
            await asyncio.to_thread(found.looks.pass_by, DEAD_AFTER_LOOKS - 1)
            await found.beats(1)
        await asyncio.to_thread(found.looks.seen)
        assert found.ending.code is None


@pytest.fixture
def written(tmp_path: Path) -> Iterator[Path]:
    """A folder with the modules that the supervisor's children run."""
    (tmp_path / "dies.py").write_text("import sys; sys.exit(3)")
    (tmp_path / "wrong.py").write_text(f"import sys; sys.exit({WRONG})")
    (tmp_path / "stays.py").write_text("import time; time.sleep(60)")
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = str(tmp_path)
    yield tmp_path
    if before is None:
        del os.environ["PYTHONPATH"]
    else:
        os.environ["PYTHONPATH"] = before


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


@pytest.fixture
def _logs_as_before() -> Iterator[None]:
    """Begin with uvicorn's loggers as a new process has them: panels of other tests have set theirs."""
    loggers = [logging.getLogger(name) for name in (None, "uvicorn", "uvicorn.error")]
    before = [(one, list(one.handlers), one.level, one.propagate) for one in loggers]
    for one in loggers[1:]:
        one.handlers[:], one.level, one.propagate = [], logging.NOTSET, True
    yield
    for one, handlers, level, propagate in before:
        one.handlers[:], one.propagate = handlers, propagate
        one.setLevel(level)
    logging.getLogger("uvicorn.error").filters.clear()


@pytest.mark.usefixtures("_logs_as_before")
def test_logs_are_json_lines_with_the_process_in_them() -> None:
    stream = io.StringIO()
    set_up_logs("controller", log_format="json", log_level="info", stream=stream)
    get_logger().info("tick_failed", tracker="T1")
    logging.getLogger("y").warning("from a library")
    get_logger().debug("not shown")

    lines = [json.loads(line) for line in stream.getvalue().splitlines()]

    assert [line["event"] for line in lines] == ["tick_failed", "from a library"]
    assert all(line["process"] == "controller" for line in lines)
    assert lines[0]["tracker"] == "T1"


@pytest.mark.usefixtures("_logs_as_before")
def test_tickets_in_logged_addresses_are_masked() -> None:
    stream = io.StringIO()
    set_up_logs("web", log_format="json", log_level="info", stream=stream)
    logging.getLogger("uvicorn.error").info(
        '%s - "WebSocket %s" 403', "192.0.2.7:51000", "/live?tracker=T1&stop_ticket=MTc5.aW&x=1"
    )
    told = json.loads(stream.getvalue())["event"]
    assert told == '192.0.2.7:51000 - "WebSocket /live?tracker=T1&stop_ticket=...&x=1" 403'


@pytest.mark.usefixtures("_logs_as_before")
@pytest.mark.parametrize("log_format", ["json", "text"])
def test_a_traceback_tells_no_values(log_format: Literal["json", "text"]) -> None:
    def fail(password: str) -> None:
        raise RuntimeError(f"a password of {len(password)} characters")

    stream = io.StringIO()
    set_up_logs("web", log_format=log_format, log_level="info", stream=stream)
    try:
        fail("violet-" + "anvil")
    except RuntimeError:
        logging.getLogger("uvicorn.error").exception("Exception in ASGI application")
    assert "a password of 12 characters" in stream.getvalue()
    assert "violet-anvil" not in stream.getvalue()


@pytest.mark.usefixtures("_logs_as_before")
def test_live_pages_that_open_are_not_told_of() -> None:
    stream = io.StringIO()
    set_up_logs("web", log_format="json", log_level="info", stream=stream)
    servers = logging.getLogger("uvicorn.error")
    servers.info('%s - "WebSocket %s" [accepted]', "192.0.2.7:51000", "/live")
    servers.info("connection open")
    servers.info("Uvicorn running")
    assert [json.loads(line)["event"] for line in stream.getvalue().splitlines()] == ["Uvicorn running"]


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
