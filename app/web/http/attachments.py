"""Answers that a browser keeps as a file."""

import re
from urllib.parse import quote

BYTE_ORDER_MARK = "\ufeff"
"""Begins a CSV that a person downloads: without it Excel reads UTF-8 as the computer's own encoding.

Files of nothing but ASCII need none, and programs that read the API get none unless they ask for it.
"""
UNUSUAL = re.compile(r"[^A-Za-z0-9._-]+")


def kept_as(name: str) -> dict[str, str]:
    """Return the header that has an answer kept under a name (RFC 6266), whatever a tracker is called."""
    plain = UNUSUAL.sub("-", name)
    whole = "" if plain == name else f"; filename*=UTF-8''{quote(name, safe='')}"
    return {"Content-Disposition": f'attachment; filename="{plain}"{whole}'}
