"""The two ways into the store: one writer for the machine, readers for everybody."""

from app.store.connections import LOG_BYTES, reading_engine, sqlite_path, writing_engine
from app.store.files import lay_out_log
from app.store.integrity import check_file
from app.store.reader import DatabaseReader
from app.store.writer import DatabaseWriter


def open_writer(url: str) -> DatabaseWriter:
    """Return the only writer of a database whose tables are up to date, or raise `StoreFailed`.

    Call `migrations.upgrade(url)` first; it makes the database if there is none.
    """
    check_file(url)
    writer, path = DatabaseWriter(reading_engine(url, keeps_open=True), writing_engine(url)), sqlite_path(url)
    if path is not None:
        lay_out_log(path, LOG_BYTES)
    return writer


def open_reader(url: str) -> DatabaseReader:
    """Return a reader; the database may appear later, until then every call raises `StoreFailed`."""
    return DatabaseReader(reading_engine(url))
