"""Libraries that few need and that weigh much: an extra each, asked for by name where one is missing."""

from importlib.util import find_spec

from app.base.errors import WRONG, Foreseen
from app.base.message import say

LIBRARIES = {"parquet": "pyarrow", "pdf": "fpdf", "postgres": "psycopg", "studies": "pvlib"}
"""The library by which an extra of pyproject.toml is known to be installed."""


class ExtraMissing(Foreseen):
    """What was asked for needs an extra that is not installed; the text has the command that installs it."""

    exit_code = WRONG


def need(extra: str) -> None:
    """Raise `ExtraMissing` unless an extra is installed."""
    if find_spec(LIBRARIES[extra]) is None:
        raise ExtraMissing(
            say(
                "This needs the extra {extra}, which is not installed. Install it with: pip install "
                '"heliopanel[{extra2}]".',
                extra=extra,
                extra2=extra,
            )
        )
