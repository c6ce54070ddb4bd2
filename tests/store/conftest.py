"""Both databases: every test that asks for `url` runs on SQLite and on PostgreSQL."""

from collections.abc import Iterator
from pathlib import Path

import pytest

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


@pytest.fixture(params=["sqlite", "postgresql"])
def empty_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a database without tables."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path / 'heliopanel.db'}"
    return fresh_database(request.getfixturevalue("postgres_folder"))


@pytest.fixture
def url(empty_url: str) -> str:
    """The address of a database with tables and nothing in them."""
    upgrade(empty_url)
    return empty_url


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
