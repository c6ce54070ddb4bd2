"""Putting a row in the place of the one with its key, with statements that are made once.

A storm over a field is thousands of them, and making one takes longer than carrying it out.
"""

from collections.abc import Mapping
from functools import cache

from sqlalchemy import Connection, Insert, Table, Update, bindparam, insert, update


def put(
    connection: Connection, table: Table, key: Mapping[str, object], values: Mapping[str, object]
) -> None:
    """Replace the row with this key, or add it; a row that is replaced keeps its place."""
    mine = {f"the_{name}": value for name, value in key.items()}
    if connection.execute(_replacing(table, tuple(key)), {**mine, **values}).rowcount == 0:
        connection.execute(adding(table), {**key, **values})


@cache
def adding(table: Table) -> Insert:
    """Return the statement that adds rows."""
    return insert(table)


@cache
def _replacing(table: Table, key: tuple[str, ...]) -> Update:
    """Return the statement that replaces the given columns of the row with a key."""
    return update(table).where(*(table.c[name] == bindparam(f"the_{name}") for name in key))
