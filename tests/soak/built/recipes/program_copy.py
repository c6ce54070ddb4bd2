"""A recipe of docs/develop/contributing.md, followed in a copy of the program and tried there."""

import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parents[4]
Edits = Mapping[str, tuple[tuple[str, str], ...]]
"""What stands in a file instead of what: each occurs there."""


PROVEN = """import app
print(app.__path__[0])
import asyncio
from tests.fakes import FakeMachine, FakeReader, fake_app, serving

{proof}
if "seen" in globals():
    asyncio.run(seen())
"""


def followed(folder: Path, edits: Edits, new: Mapping[str, str], proof: str) -> None:
    """Copy the program into a folder, change it there, and fail unless the proof runs there."""
    shutil.copytree(ROOT / "app", folder / "app", ignore=shutil.ignore_patterns("__pycache__", "locale"))
    touched = frozenset(folder / name for name in (*edits, *new))
    for name in ("docs", "static", "templates", "tests", "alembic", "app/web/locale"):
        _link(ROOT / name, folder / name, touched)
    for name, text in new.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    for name, changes in edits.items():
        text = (folder / name).read_text()
        for before, after in changes:
            assert before in text, f"{name} has no {before!r}: change the recipe too"
            text = text.replace(before, after, 1)
        (folder / name).write_text(text)
    told = subprocess.run(
        (sys.executable, "-c", PROVEN.replace("{proof}", proof)),
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert told.stdout.split()[:1] == [str(folder / "app")], told.stderr
    assert told.returncode == 0, told.stderr


def _link(source: Path, target: Path, touched: frozenset[Path]) -> None:
    """Link what nobody touches, and copy the file that is changed."""
    if target in touched:
        shutil.copyfile(source, target)
    elif any(target in one.parents for one in touched):
        target.mkdir()
        for one in source.iterdir():
            _link(one, target / one.name, touched)
    else:
        target.symlink_to(source)
