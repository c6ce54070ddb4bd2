"""Which version of Heliopanel wrote a database last; an older one refuses it, whatever its tables are."""

import re

from sqlalchemy import Connection, inspect, select

from app.base.build import VERSION
from app.base.message import say
from app.store.putting import put
from app.store.store import StoreUnfit
from app.store.tables import software

NUMBER = 1
NUMBERS = re.compile(r"(\d+)\.(\d+)\.(\d+)")


def version_of(connection: Connection) -> str | None:
    """Return the version that wrote a database, None where none was noted yet."""
    if not inspect(connection).has_table(software.name):
        return None
    return connection.execute(select(software.c.version)).scalar_one_or_none()


def note_version(connection: Connection, version: str) -> None:
    """Note which version writes from now on."""
    put(connection, software, {"number": NUMBER}, {"version": version})


def refuse_newer(connection: Connection) -> None:
    """Raise `StoreUnfit` for a database that a newer version has written."""
    found = version_of(connection)
    if found is not None and is_newer(found, VERSION):
        raise StoreUnfit(
            say(
                "The database was written by a newer version of Heliopanel ({found}; this version is "
                "{version}). Install that version, or restore a backup that this version wrote.",
                found=found,
                version=VERSION,
            )
        )


def is_newer(version: str, than: str) -> bool:
    """Return whether a version is newer; one whose order is not known counts as newer."""
    one, other = NUMBERS.fullmatch(version), NUMBERS.fullmatch(than)
    if one is None or other is None:
        return version != than
    return [int(part) for part in one.groups()] > [int(part) for part in other.groups()]
