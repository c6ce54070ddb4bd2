"""What a database says when it cannot, as sentences that say what to do."""

from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError, SQLAlchemyError

from app.base.message import N_, say
from app.store.store import StoreDamaged, StoreFailed

SENTENCES = (
    ("SQLITE_FULL", N_("The disk is full: nothing was stored. Free some space or delete old recordings.")),
    ("SQLITE_BUSY", N_("The database is locked by another program: nothing was stored. End that program.")),
    ("SQLITE_NOTADB", N_("The file is not a database. Restore a backup with: heliopanel restore FILE.")),
    ("SQLITE_CORRUPT", N_("The database file is damaged. Restore a backup with: heliopanel restore FILE.")),
    ("SQLITE_IOERR", N_("The disk failed to read or write. Check the disk or card, then restart "
        "Heliopanel.")),
    ("SQLITE_READONLY",
     N_("The database file cannot be written. Give Heliopanel's user write permission for it.")),
    ("SQLITE_CANTOPEN", N_("The database file cannot be opened. Check that the data folder exists.")),
)  # fmt: skip
UNREACHABLE = ("", "57P01", "57P02", "57P03", "08006")
"""PostgreSQL: no answer at all, shut down, crashed, not yet started, connection lost."""

DAMAGED = ("SQLITE_CORRUPT", "SQLITE_NOTADB")
LASTING = ("SQLITE_IOERR", *DAMAGED)


def code_of(error: BaseException) -> str:
    """Return the database's own name of an error, empty if it has none."""
    cause = error.orig if isinstance(error, DBAPIError) else error
    return str(getattr(cause, "sqlite_errorname", None) or getattr(cause, "sqlstate", None) or "")


def is_lasting(error: BaseException) -> bool:
    """Return whether the file must not be trusted until it was opened and checked again."""
    return code_of(error).startswith(LASTING)


def explained(error: SQLAlchemyError) -> StoreFailed:
    """Return the failure as the person who reads it needs it."""
    code = code_of(error)
    for name, sentence in SENTENCES:
        if code.startswith(name):
            return StoreDamaged(sentence) if code.startswith(DAMAGED) else StoreFailed(sentence)
    first_line = str(getattr(error, "orig", None) or error).strip().split("\n", maxsplit=1)[0]
    if isinstance(error, InterfaceError | OperationalError) and code in UNREACHABLE:
        return StoreFailed(
            say(
                "The database cannot be reached: nothing was stored. Check that it runs ({first_line}).",
                first_line=first_line,
            )
        )
    return StoreFailed(
        say(
            "The database rejected the data: nothing was stored ({value}: {first_line}).",
            value=code or N_("no code"),
            first_line=first_line,
        )
    )
