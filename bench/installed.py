"""Installed: what an installation without extras takes on the disk, and what each of its libraries is for"""

import marshal
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from filecmp import cmp
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from bench.table import NotMeasured, Row, alone, at_most

COMMAND = "python -m bench installed"
ROOT = Path(__file__).resolve().parents[1]
OWN = "heliopanel"
BOUND_MB = 240.0
MEGABYTE = 1024 * 1024
BLOCK = 4096
CARRIED = ("app", "alembic", "docs", "manual", "static", "templates")
SMALL = None
EXTRAS = ("studies", "parquet", "pdf", "postgres")
PURPOSES = {
    "aiomqtt": "MQTT to brokers and Home Assistant",
    "alembic": "migrations of the database",
    "argon2-cffi": "hashes of passwords",
    "cryptography": "Heliopanel's own certificate",
    "fastapi": "REST API, pages and their routes",
    OWN: "the program, its pages, documents, languages and migrations",
    "httptools": "reading HTTP quickly",
    "jinja2": "pages made of templates",
    "jinja2-fragments": "parts of a page, for htmx",
    "markdown-it-py": "documents shown on pages",
    "numpy": "the sun over a day, columns of recordings",
    "orjson": "live values as JSON, once for all viewers",
    "pillow": "photos of a record made small and plain",
    "prometheus-client": "the text of /metrics",
    "pydantic": "input is validated; JSON of orders, settings and records",
    "pydantic-settings": "settings from environment and file",
    "pymodbus": "frames of Modbus, to drives and to SunSpec",
    "pyserial": "serial lines",
    "python-multipart": "forms and uploads",
    "segno": "QR codes of trackers",
    "sqlalchemy": "one code for SQLite and PostgreSQL",
    "typer": "the command line",
    "tzdata": "civil time where the system has no time zones",
    "tzfpy": "the time zone of a place, offline",
    "uvicorn": "the HTTP server",
    "uvloop": "a quick event loop",
    "websockets": "live values and hold-to-run buttons",
}
"""What each library is for that Heliopanel asks for itself; what these bring is told with who needs it."""


@dataclass
class Library:
    """One library of an installation: the bytes that it takes, and which others ask for it."""

    name: str
    size: int
    needed_by: set[str] = field(default_factory=set)

    @property
    def purpose(self) -> str:
        """Return what it is for."""
        return PURPOSES.get(self.name) or f"needed by {', '.join(sorted(self.needed_by))}"


def measure(_: None = SMALL) -> list[Row]:
    """Return the whole, each extra, and each library of an installation without extras."""
    base = installation()
    whole_mb = sum(one.size for one in base.values()) / MEGABYTE
    rows = [
        at_most(
            f"installation without extras, Heliopanel and {len(base) - 1} libraries",
            whole_mb,
            BOUND_MB,
            "MB",
            COMMAND,
        )
    ]
    for extra in EXTRAS:
        more = installation(extra)
        added = sum(one.size for name, one in more.items() if name not in base)
        rows.append(alone(f"the extra {extra} adds", _told(added), COMMAND))
    by_size = sorted(base.values(), key=lambda one: (-one.size, one.name))
    return [*rows, *(alone(f"{one.name}: {one.purpose}", _told(one.size), COMMAND) for one in by_size)]


@cache
def installation(extra: str = "") -> dict[str, Library]:
    """Return all that is installed with Heliopanel, and with one extra of it, by name."""
    found = {OWN: Library(OWN, _own_size())}
    waiting = [(OWN, extra)]
    while waiting:
        name, wanted = waiting.pop()
        for needed in _needs(name, wanted):
            key = canonicalize_name(needed.name)
            if key == OWN:
                continue
            if key not in found:
                found[key] = Library(key, _size(key))
                waiting += [(key, inner) for inner in ("", *needed.extras)]
            found[key].needed_by.add(name)
    return found


def _needs(name: str, extra: str) -> Iterator[Requirement]:
    """Yield what a distribution asks for on this computer, with one of its extras."""
    for line in _ours(extra) if name == OWN else _distribution(name).requires or ():
        needed = Requirement(line)
        if needed.marker is None or needed.marker.evaluate({"extra": extra}):
            yield needed


def _ours(extra: str) -> list[str]:
    """Return what Heliopanel asks for by this checkout, whatever was installed."""
    project: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    more: dict[str, list[str]] = project["optional-dependencies"]
    return [*project["dependencies"], *more.get(extra, ())]


def _distribution(name: str) -> Distribution:
    try:
        return distribution(name)
    except PackageNotFoundError as error:
        raise NotMeasured(f"{name} is not installed: run make setup") from error


def _size(name: str) -> int:
    """Return what the files of a distribution take on the disk."""
    files = _distribution(name).files or ()
    return _on_disk(Path(str(file.locate())) for file in files)


def _own_size() -> int:
    """Return what the wheel of this checkout takes once it is installed, its compiled modules included."""
    paths = [path for folder in CARRIED for path in (ROOT / folder).rglob("*") if _is_carried(path)]
    compiled = (_compiled_size(path) for path in paths if path.suffix == ".py")
    return _on_disk(paths) + sum(-(-size // BLOCK) * BLOCK for size in compiled)


def _compiled_size(path: Path) -> int:
    return len(marshal.dumps(compile(path.read_bytes(), path.name, "exec")))


def _is_carried(path: Path) -> bool:
    """Return whether a file goes into the wheel, as `setup.py` says; a manual that was not built does not."""
    if not path.is_file() or "__pycache__" in path.parts or path.suffix == ".po" or path.name == "show.gif":
        return False
    if not path.is_relative_to(ROOT / "manual"):
        return True
    document = ROOT / "docs" / path.relative_to(ROOT / "manual")
    return not document.is_file() or not cmp(path, document)


def _on_disk(paths: Iterable[Path]) -> int:
    return sum(path.stat().st_blocks * 512 for path in paths if path.is_file())


def _told(size: int) -> str:
    return f"{size / MEGABYTE:.1f} MB"
