"""What cannot work is one sentence and exit code 2: real processes that end and leave none behind."""

import os
import socket
import subprocess
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import text

from app.access.opening import open_store
from app.access.roles import Role
from app.access.users import User
from app.base.build import VERSION
from app.base.settings import Settings
from app.store.connections import sharing_engine, transaction, writing_engine
from app.store.engine import open_writer
from app.store.migrations import upgrade
from tests.e2e.product import COMMAND
from tests.ports import free_port

NOW = datetime(2026, 11, 21, 9, tzinfo=UTC)
NEWER = "999.0.1"
PATIENCE_S = 100.0
Refusal = tuple[int, str, list[str]]


def started(command: str, data: Path, *, port: int | None = None, **more: str) -> Refusal:
    """Run a service until it ends by itself, with everything that it started; return code and output."""
    own = {"HELIOPANEL_DATA_DIR": str(data), "HELIOPANEL_PORT": str(port or free_port())}
    given = os.environ | own | {f"HELIOPANEL_{name}": value for name, value in more.items()}
    # Whoever is left behind would hold the pipes open, and this would not come back.
    done = subprocess.run(
        [COMMAND, *command.split()], env=given, capture_output=True, text=True, timeout=PATIENCE_S
    )
    return done.returncode, done.stdout, done.stderr.splitlines()


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """Return a data folder with a database of this version and a user."""
    settings = Settings(data_dir=tmp_path / "data")
    upgrade(settings.url)
    writer = open_writer(settings.url)
    writer.save_software(VERSION)
    writer.close()
    store = open_store(settings)
    with store.writing() as change:
        change.put_user(User("ada", frozenset({Role.ADMINISTRATOR}), "hash", NOW, NOW))
    store.close()
    return settings.data_dir


def users_by_newer(data: Path) -> None:
    """Have the users tell that a newer version wrote them."""
    engine = sharing_engine(f"sqlite:///{data / 'access.db'}")
    with transaction(engine) as connection:
        connection.execute(text("UPDATE access_meta SET value = :v WHERE name = 'version'"), {"v": NEWER})
    engine.dispose()


def database_by_newer(data: Path) -> None:
    """Have the database tell that a newer version wrote it."""
    engine = writing_engine(f"sqlite:///{data / 'heliopanel.db'}")
    with transaction(engine) as connection:
        connection.execute(text("UPDATE software SET version = :v"), {"v": NEWER})
    engine.dispose()


@pytest.mark.parametrize("command", ["serve", "controller"])
def test_a_data_folder_that_cannot_be_made(command: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    code, out, err = started(command, tmp_path / "file" / "data")
    assert (code, out, len(err)) == (2, "", 1)
    assert err[0].startswith(
        f"The folder {tmp_path / 'file' / 'data'} cannot be made (Not a directory). Give"
    )


def test_a_busy_port(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        code, out, err = started("serve", tmp_path / "data", port=port)
    assert (code, out, len(err)) == (2, "", 1)
    assert f"cannot listen on 127.0.0.1 port {port}: Address already in use." in err[0]
    assert not (tmp_path / "data" / "heliopanel.db").exists()


@pytest.mark.parametrize(
    ("command", "name", "value"),
    [
        *(("serve", "TICK_MS", "soon"), ("serve", "PORT", "99999")),
        *(("web", "TICK_MS", "soon"), ("controller", "PORT", "99999")),
    ],
)
def test_a_wrong_setting(command: str, name: str, value: str, tmp_path: Path) -> None:
    code, out, err = started(command, tmp_path / "data", **{name: value})
    assert (code, out, len(err)) == (2, "", 1)
    assert err[0].startswith(f"HELIOPANEL_{name}")
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize(
    ("command", "write", "what"),
    [
        ("serve", users_by_newer, "The users were stored"),
        ("web", users_by_newer, "The users were stored"),
        ("users list", users_by_newer, "The users were stored"),
        ("serve", database_by_newer, "The database was written"),
        ("controller", database_by_newer, "The database was written"),
    ],
)
def test_what_a_newer_version_wrote(
    command: str, write: Callable[[Path], None], what: str, data: Path
) -> None:
    write(data)
    code, _, err = started(command, data, LOG_LEVEL="error")
    told = f"{what} by a newer version of Heliopanel ({NEWER}; this version is {VERSION}). Install"
    assert (code, len(err)) == (2, 1)
    assert err[0].startswith(told)
