"""Which software this is: its version and the day it was made."""

from datetime import UTC, datetime
from importlib.metadata import version

VERSION = version("heliopanel")
BUILT_AT = datetime(2026, 11, 21, tzinfo=UTC)
"""No clock can truly show an earlier instant: one that does is wrong."""
