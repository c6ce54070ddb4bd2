"""Which software this is: its version and the day it was made."""

from datetime import UTC, datetime

VERSION = "0.2.0"
"""The only place that says it: package, pages, API, records, database and gateways take it from here."""
BUILT_AT = datetime(2026, 11, 21, tzinfo=UTC)
"""No clock can truly show an earlier instant: one that does is wrong."""
