"""Everything that support needs, as files of a zip: versions, settings without secrets, state, journal."""

import io
import platform
import shutil
import zipfile
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import orjson
from sqlalchemy import make_url

from app.base.addresses.masking import without_secrets
from app.base.build import VERSION
from app.base.settings import Settings
from app.link.messages import Machine
from app.store.store import JournalFilter, Reader
from app.web.services.counting import counted

NEWEST = 1000
Parts = dict[str, Any]


def about(settings: Settings, now: datetime) -> Parts:
    """Return which software this is, on what, with which settings and files."""
    told = {
        "version": VERSION,
        "written_at": now,
        "python": platform.python_version(),
        "system": platform.platform(),
        "files": _files(settings.data_dir),
    }
    return {"about.json": told, "settings.json": without_passwords(settings)}


async def live(machine: Machine) -> Parts:
    """Return what the machine says of itself, or raise `MachineUnreachable`."""
    return {
        "site.json": await machine.detail(),
        "snapshot.json": machine.latest(),
        "metrics.json": await counted(machine),
    }


def stored(reader: Reader) -> Parts:
    """Return the newest events of the journal."""
    return {"journal.json": reader.journal(JournalFilter(limit=NEWEST))}


def without_passwords(settings: Settings) -> Parts:
    """Return all settings as plain data, passwords and secrets hidden."""
    shown: Parts = settings.model_dump(mode="json")
    if settings.database_url:
        shown["database_url"] = make_url(settings.database_url).render_as_string(hide_password=True)
    return shown


def zipped(parts: Mapping[str, Any]) -> bytes:
    """Return the parts as a zip file, addresses that may hold a secret masked."""
    content = io.BytesIO()
    options = orjson.OPT_INDENT_2 | orjson.OPT_NON_STR_KEYS
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in parts.items():
            plain = orjson.loads(orjson.dumps(part, option=options))
            archive.writestr(name, orjson.dumps(without_secrets(plain), option=options))
    return content.getvalue()


def _files(folder: Path) -> Parts:
    """Return how large the files of the data folder are, and how much is free beside them."""
    try:
        sizes = {path.name: path.stat().st_size for path in sorted(folder.iterdir()) if path.is_file()}
        return {"sizes_bytes": sizes, "free_bytes": shutil.disk_usage(folder).free}
    except OSError as error:
        return {"error": str(error.strerror)}
