"""Both databases: every test that asks for `url` runs on SQLite and on PostgreSQL."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy.engine import make_url

from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.store.reader import DatabaseReader
from app.store.writer import DatabaseWriter
from tests.store.postgres import fresh_database, running_postgres


@pytest.fixture(scope="session")
def postgres_folder() -> Iterator[Path]:
    with running_postgres() as folder:
        yield folder


@pytest.fixture
def sqlite_url(tmp_path: Path) -> str:
    return f"sqlite:///{tmp_path / 'heliopanel.db'}"


@pytest.fixture(scope="session")
def made_sqlite(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with tables and nothing in them, to be copied."""
    path = tmp_path_factory.mktemp("made") / "heliopanel.db"
    upgrade(f"sqlite:///{path}")
    return path


@pytest.fixture(scope="session")
def made_postgres(postgres_folder: Path) -> str:
    """The name of a database with tables and nothing in them, to be copied."""
    made = fresh_database(postgres_folder)
    upgrade(made)
    return str(make_url(made).database)


@pytest.fixture(params=["sqlite", "postgresql"])
def kind(request: pytest.FixtureRequest) -> str:
    """The kind of database that a test runs on."""
    return str(request.param)


@pytest.fixture
def empty_url(kind: str, request: pytest.FixtureRequest, sqlite_url: str) -> str:
    """The address of a database without tables."""
    return sqlite_url if kind == "sqlite" else fresh_database(request.getfixturevalue("postgres_folder"))


@pytest.fixture
def url(kind: str, request: pytest.FixtureRequest, tmp_path: Path, sqlite_url: str) -> str:
    """The address of a database with tables and nothing in them."""
    if kind == "sqlite":
        shutil.copy(request.getfixturevalue("made_sqlite"), tmp_path / "heliopanel.db")
        return sqlite_url
    folder = request.getfixturevalue("postgres_folder")
    return fresh_database(folder, request.getfixturevalue("made_postgres"))


@pytest.fixture
def writer(url: str) -> Iterator[DatabaseWriter]:
    opened = open_writer(url)
    yield opened
    opened.close()


@pytest.fixture
def reader(url: str) -> Iterator[DatabaseReader]:
    opened = open_reader(url)
    yield opened
    opened.close()
