"""Run the README's two commands on pristine Debian machines, and print a table of what came of it."""

import argparse
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from dataclasses import dataclass
from pathlib import Path

from tools.fresh.machine import BUILD, INTERPRETER, USER, Machine, machine, stop

ANSWERS_WITHIN_S = 1200
STOPS_WITHIN_S = 30
NAMED = re.compile(r"^(?:sudo )?(apt-get install [a-z0-9. -]+?)\s*(?:#.*)?$", re.MULTILINE)
"""The line of the README that installs what a Debian needs before the two commands."""
SAID = re.compile(r"Install them with: sudo (apt-get install [a-z0-9. -]+)$", re.MULTILINE)
"""What make test says to a user who may not install."""
COUNTED = re.compile(r"^=+ (.*\d+ (?:passed|failed|error).*) =+$", re.MULTILINE)


@dataclass
class Row:
    """One command on one machine."""

    debian: str
    who: str
    python: str
    command: str
    good: bool
    told: str
    seconds: float


def named_by_readme(text: str) -> str:
    """Return the README's own command that installs what is needed."""
    found = NAMED.search(text)
    if not found:
        sys.exit("README.md does not say with a line `apt-get install ...` what a Debian needs.")
    return f"{found[1]} --yes --no-install-recommends"


def free_port() -> int:
    """Return the panel's port, or another where something else on this computer has it."""
    with socket.socket() as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind(("127.0.0.1", 8000))
        except OSError:
            tried.bind(("127.0.0.1", 0))
        return int(tried.getsockname()[1])


def answers(port: int) -> bool:
    """Return whether the first page is served."""
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    try:
        with opener.open(f"http://127.0.0.1:{port}/", timeout=10) as page:
            return page.status == 200 and b"Heliopanel" in page.read()
    except OSError:
        return False


def ended(process: subprocess.Popen[str], port: int) -> bool:
    """Press Ctrl-C and return whether the panel ends and gives its port back."""
    stop(process)
    until = time.monotonic() + STOPS_WITHIN_S
    while time.monotonic() < until:
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)):
                return True
        time.sleep(0.2)
    return False


def run(on: Machine, who: str, make: str) -> tuple[bool, str]:
    """`make run` until the page answers; then Ctrl-C."""
    port = free_port()
    setting = "" if port == 8000 else f"HELIOPANEL_PORT={port} "
    begun = time.monotonic()
    process = on.start(f"cd heliopanel && {setting}{make} run", who)
    while (
        not (there := answers(port))
        and process.poll() is None
        and time.monotonic() - begun < ANSWERS_WITHIN_S
    ):
        time.sleep(0.5)
    told = f"{'200' if there else 'no answer'} on port {port} after {time.monotonic() - begun:.0f} s"
    stopped = ended(process, port)
    return there and stopped, told + ("" if stopped else ", and did not stop")


def test(on: Machine, who: str, make: str) -> tuple[bool, str]:
    """`make test`; what it says is missing is installed by root, and the user asks again."""
    line, first = f"cd heliopanel && {make} test", ""
    code, told = on.do(line, who)
    needed = SAID.search(told)
    if code and who != "root" and needed:
        installed, _ = on.do(f"DEBIAN_FRONTEND=noninteractive {needed[1]} --yes -qq", "root")
        first = "what to install was said" + (", and that failed; " if installed else "; ")
        code, told = on.do(line, who)
    return code == 0, first + ("; ".join(COUNTED.findall(told)) or "did not get to the tests")


def prepare(on: Machine, who: str, python: str, project: Path) -> bool:
    """Install what the README names, and clone the project."""
    more = f" {python} {python}-venv" if python and "/" not in python else ""
    needed = named_by_readme(Path("README.md").read_text())
    installed, _ = on.do(f"apt-get update -qq && DEBIAN_FRONTEND=noninteractive {needed}{more} -qq", "root")
    shutil.copy(project, on.root / "srv/heliopanel.bundle")
    cloned, _ = on.do("git clone -q -c advice.detachedHead=false /srv/heliopanel.bundle heliopanel", who)
    return not (installed or cloned)


def one(debian: str, who: str, asked: argparse.Namespace, project: Path) -> list[Row]:
    """Do what is asked on one machine, and say it as it comes."""
    path = Path(asked.python).resolve() if "/" in asked.python else None
    python = f"{INTERPRETER}/bin/{path.name}" if path else asked.python
    make = f"make PYTHON={python}" if python else "make"
    rows: list[Row] = []
    user = "root" if who == "root" else USER
    with machine(debian, who, path) as on:
        ready = prepare(on, user, asked.python, project)
        _, version = on.do(f"{python or 'python3'} --version", user)
        version = (re.findall(r"^Python (\S+)$", version, re.MULTILINE) or ["none"])[0]
        for command, try_it in (("run", run), ("test", test)):
            if command not in asked.only:
                continue
            begun = time.monotonic()
            good, told = try_it(on, user, make) if ready else (False, "the README's first line failed")
            rows.append(Row(debian, who, version, f"make {command}", good, told, time.monotonic() - begun))
            print(line(rows[-1]), flush=True)
        if not all(row.good for row in rows):
            print(f"See {on.log.name}", flush=True)
    return rows


def line(row: Row) -> str:
    """Return a row of the table."""
    judged = "ok" if row.good else "FAILED"
    return (
        f"{row.debian:8}{row.who:6}{row.python:8}{row.command:11}{judged:8}{row.seconds:6.0f} s  {row.told}"
    )


def main() -> None:
    """Read what is asked, build a machine for each and judge."""
    parser = argparse.ArgumentParser(prog="make fresh", description=__doc__)
    parser.add_argument("--debian", action="append", help="12, 13 or a suite as testing")
    parser.add_argument("--who", action="append", choices=["user", "root"])
    parser.add_argument("--only", action="append", choices=["run", "test"])
    parser.add_argument(
        "--python", default="", help="a package of that Debian, or the path of one of this computer"
    )
    asked = parser.parse_args()
    asked.debian, asked.who = asked.debian or ["12", "13"], asked.who or ["user", "root"]
    asked.only = asked.only or ["run", "test"]
    if os.geteuid() != 0:
        sys.exit("make fresh makes mounts, so it needs root: sudo make fresh")
    # Whoever ends it finds its machines taken away, as after Ctrl-C.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    BUILD.mkdir(parents=True, exist_ok=True)
    BUILD.chmod(0o700)
    git = ["git", "-c", "safe.directory=*"]
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder) / "heliopanel.bundle"
        subprocess.run([*git, "bundle", "create", "-q", project, "HEAD"], check=True)
        rows = [
            row for debian in asked.debian for who in asked.who for row in one(debian, who, asked, project)
        ]
    print("\ndebian  who   python  command    result    time  what was seen")
    print("\n".join(line(row) for row in rows))
    sys.exit(not all(row.good for row in rows))


if __name__ == "__main__":
    main()
