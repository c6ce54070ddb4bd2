"""Both databases: every test that asks for `database` runs on a file of its own and on PostgreSQL."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.access.roles import Role
from tests.access.door import Door
from tests.store.postgres import fresh_database, running_postgres


@pytest.fixture(scope="session")
def postgres_folder() -> Iterator[Path]:
    with running_postgres() as folder:
        yield folder


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest) -> str | None:
    """The address of an empty database that users are kept in; None for the file in the data folder."""
    if request.param == "sqlite":
        return None
    return fresh_database(request.getfixturevalue("postgres_folder"))


@pytest.fixture
def new_door(tmp_path: Path) -> Iterator[Door]:
    """A door without users; they will be kept in a file."""
    door = Door(tmp_path)
    yield door
    door.keeper.close()


@pytest.fixture
async def door(new_door: Door) -> Door:
    """A door with one user: ada, an administrator."""
    await new_door.add("ada", Role.ADMINISTRATOR)
    return new_door
