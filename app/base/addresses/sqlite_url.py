"""The address of a SQLite file, whatever its folder is called."""

from pathlib import Path


def sqlite_url(path: Path) -> str:
    """Return the database URL of a file: a `?` or `%` of its name is no part of the URL's own language."""
    return f"sqlite:///{str(path).replace('%', '%25').replace('?', '%3F')}"
