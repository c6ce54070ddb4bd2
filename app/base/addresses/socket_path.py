"""Where the Unix socket beside a data folder lies, whatever the folder is called."""

import hashlib
import os
import tempfile
from pathlib import Path

LONGEST_PATH = 100
"""In bytes, of which a letter beyond ASCII has up to four."""


def socket_path(wanted: Path) -> Path:
    """Return the path itself, or a short one that stands for it, as the system limits the length.

    One in `/tmp` always fits.
    """
    name = f"heliopanel-{hashlib.sha256(os.fsencode(wanted)).hexdigest()[:16]}.sock"
    short = (wanted, Path(tempfile.gettempdir()) / name)
    fits = (one for one in short if len(os.fsencode(one)) <= LONGEST_PATH)
    return next(fits, Path("/tmp") / name)  # noqa: S108  # nosec B108
