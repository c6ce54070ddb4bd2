"""A PostgreSQL server for the tests alone: in a temporary folder, on a Unix socket."""

import os
import pwd
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

import psycopg

from tests.patience import PATIENCE_S

MISSING = (
    "The tests need PostgreSQL. Install it with: sudo apt-get install --no-install-recommends postgresql"
)
NUMBERS = count(1)
SETTINGS = {
    "fsync": "off",
    "listen_addresses": "",
    "max_connections": "40",
    "shared_buffers": "16MB",
    "autovacuum": "off",
}


@contextmanager
def running_postgres() -> Iterator[Path]:
    """Yield the folder of the socket of a fresh server; the server and its folder go with the context."""
    programs = _programs()
    folder = Path(tempfile.mkdtemp(prefix="heliopanel-pg-"))
    try:
        if os.geteuid() == 0:
            owner = pwd.getpwnam("postgres")
            os.chown(folder, owner.pw_uid, owner.pw_gid)
        data = folder / "data"
        _run(programs / "initdb", "-D", data, "-U", "heliopanel", "-A", "trust", "-N", "-E", "UTF8")
        options = " ".join(f"-c {name}='{value}'" for name, value in SETTINGS.items())
        _run(
            programs / "pg_ctl",
            "-D",
            data,
            "-w",
            "-l",
            folder / "log",
            "-o",
            f"{options} -k {folder}",
            "start",
        )
        try:
            yield folder
        finally:
            _run(programs / "pg_ctl", "-D", data, "-w", "-m", "immediate", "stop")
    finally:
        shutil.rmtree(folder)


def fresh_database(folder: Path, like: str = "template1") -> str:
    """Return the URL of a new database on the server, empty or a copy of another one."""
    name = f"test{next(NUMBERS)}"
    with psycopg.connect(f"host={folder} user=heliopanel dbname=postgres", autocommit=True) as connection:
        connection.execute(f"CREATE DATABASE {name} TEMPLATE {like}")
    return f"postgresql+psycopg://heliopanel@/{name}?host={folder}"


def _programs() -> Path:
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    if not found:
        raise RuntimeError(MISSING)
    return found[-1].parent


def _run(*command: object) -> None:
    """Run one of PostgreSQL's programs; they refuse to run as root, so then as the user made for them."""
    as_owner = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []
    done = subprocess.run(
        [*as_owner, *map(str, command)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE if "start" not in command else subprocess.DEVNULL,
        stderr=subprocess.STDOUT,
        cwd="/",
        timeout=PATIENCE_S,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))} failed: {(done.stdout or b'').decode()}")
