"""The product as a user starts it: `heliopanel serve` and `heliopanel drive-sim`, processes of their own."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from http.client import HTTPConnection, HTTPException
from pathlib import Path

from app.machine.process import FIFO_PRIORITY
from tests.patience import PATIENCE_S
from tests.patience import until as eventually
from tests.ports import free_port

__all__ = ["COMMAND", "DRIVE_SIM", "DriveSim", "Product", "end"]

DRIVE_SIM = (sys.executable, "-c", "import typer; from app.cli.drives import drive_sim; typer.run(drive_sim)")
"""The command `heliopanel drive-sim` alone, without the panel and machine that `heliopanel` imports."""
COMMAND = str(Path(sys.executable).with_name("heliopanel"))


def end(process: subprocess.Popen[bytes]) -> int:
    """End a process, by force if it does not go."""
    if process.poll() is None:
        process.terminate()
    try:
        return process.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


@dataclass
class DriveSim:
    """`heliopanel drive-sim` on a free port."""

    port: int
    process: "subprocess.Popen[bytes]"

    @classmethod
    def start(cls, port: int | None = None, memory: Path | None = None, units: int = 1) -> "DriveSim":
        """Return once it listens; with a memory it knows its position after a power cut at rest.

        A real drive has a computer of its own: other programs must not make this one answer late.
        """
        port = port or free_port()
        kept = [] if memory is None else ["--memory", str(memory)]
        kept += [f"--unit={unit}" for unit in range(1, units + 1)]
        process = subprocess.Popen([*DRIVE_SIM, "--tcp", f"127.0.0.1:{port}", *kept], stdout=subprocess.PIPE)
        if os.environ.get("HELIOPANEL_REAL_TIME") != "off":
            with suppress(PermissionError):
                os.sched_setscheduler(process.pid, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY + 1))
        assert process.stdout is not None
        assert process.stdout.readline(), "drive-sim did not start"
        return cls(port, process)

    def stop(self) -> None:
        """End it."""
        assert self.process.stdout is not None
        end(self.process)
        self.process.stdout.close()


@dataclass
class Product:
    """`heliopanel serve` with a data folder and a port of its own."""

    data_dir: Path
    port: int
    process: "subprocess.Popen[bytes]"
    lines: list[dict[str, object]] = field(default_factory=list)
    reading: threading.Thread | None = None

    @classmethod
    def start(cls, data_dir: Path, *, command: Sequence[str] = (), **more: str) -> "Product":
        """Return once panel, machine and database answer; `more` are further settings."""
        product = cls.begin(data_dir, command=command, **more)
        try:
            product.until_ready()
        except TimeoutError:
            product.stop()
            raise
        return product

    @classmethod
    def begin(cls, data_dir: Path, *, command: Sequence[str] = (), **more: str) -> "Product":
        """Return while it starts.

        An installed product finds its modules compiled; this one keeps them compiled too, for the next start.
        """
        port = free_port()
        environment = os.environ | {
            "HELIOPANEL_DATA_DIR": str(data_dir),
            "HELIOPANEL_PORT": str(port),
            "HELIOPANEL_LOG_FORMAT": "json",
            **{f"HELIOPANEL_{name.upper()}": value for name, value in more.items()},
        }
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        process = subprocess.Popen(
            [*(command or (COMMAND,)), "serve"],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        product = cls(data_dir, port, process)
        product.reading = threading.Thread(target=product._read, daemon=True)
        product.reading.start()
        return product

    @property
    def url(self) -> str:
        """Return where a browser finds it."""
        return f"http://127.0.0.1:{self.port}"

    def until_ready(self) -> None:
        """Return once panel, machine and database answer, or fail."""
        eventually(self.is_ready, "panel, machine and database answer")

    def is_ready(self) -> bool:
        """Return whether panel, machine and database answer now.

        This is asked all the time while the product starts: httpx would read every authority of the computer
        each time, and take the processor from what is waited for.
        """
        asking = HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        with closing(asking), suppress(OSError, HTTPException):
            asking.request("GET", "/ready")
            return asking.getresponse().status == 200
        return False

    def starts(self, child: str) -> list[int]:
        """Return the process ids that `machine` or `web` has had."""
        return [
            int(str(line["process_id"]))
            for line in list(self.lines)
            if line.get("event") == "child_started" and line.get("child") == child
        ]

    def deaths(self) -> list[str]:
        """Return which child has died of what, in order: a code below 0 is the signal that killed it."""
        return [
            f"{line['child']} {line['code']}"
            for line in list(self.lines)
            if line.get("event") == "child_died"
        ]

    def signal(self, child: str, number: signal.Signals) -> float:
        """Send a signal to the newest process of a child and return when."""
        process_id = self.starts(child)[-1]
        os.kill(process_id, number)
        return time.monotonic()

    def stop(self) -> int:
        """End it and everything it started, whatever state the tests left it in."""
        for child in ("controller", "web"):
            for process_id in self.starts(child)[-1:]:
                with suppress(ProcessLookupError):
                    os.kill(process_id, signal.SIGCONT)
        code = end(self.process)
        if self.reading is not None:
            self.reading.join()
        assert self.process.stderr is not None
        self.process.stderr.close()
        return code

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            with suppress(ValueError):
                self.lines.append(json.loads(line))
