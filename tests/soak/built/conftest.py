"""A release, made once in a copy of these sources and installed; a product and a drive for what only asks."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path

import pytest

from release import artifacts
from release.__main__ import git, make
from tests.e2e import product as serving
from tests.e2e.product import Product
from tests.ports import free_port
from tests.soak.timing.conftest import drive, integrator, product

__all__ = ["drive", "integrator", "product"]

ROOT = Path(__file__).resolve().parents[3]
VERSION, DAY = "9.9.0", date(2030, 5, 17)
NEWS = "- The panel whistles."
ANOTHER_APP = 'raise SystemExit("The folder that this was started in has an app of its own.")'


def copied(to: Path) -> Path:
    """Return a repository of its own with these sources, changed or not; it has news for a release."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    for name in {name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()}:
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, to / name)
    changelog = to / "CHANGELOG.md"
    changelog.write_text(
        changelog.read_text().replace("## [Unreleased]", f"## [Unreleased]\n\n### Added\n\n{NEWS}")
    )
    # Its data folder takes a minute to write; tests/golden/databases/__main__.py is run for each release.
    shutil.copytree(to / "tests/golden/databases/0.1.0", to / "tests/golden/databases" / VERSION)
    git(to, "init", "--quiet", "--initial-branch=main")
    for setting, value in (
        ("user.name", "Ada"),
        ("user.email", "ada@localhost"),
        ("commit.gpgsign", "false"),
    ):
        git(to, "config", setting, value)
    git(to, "add", "--all")
    git(to, "commit", "--quiet", "-m", "before")
    return to


@pytest.fixture(scope="package")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy in which the release was made."""
    copy = copied(tmp_path_factory.mktemp("sources"))
    with pytest.MonkeyPatch.context() as patch:
        # Whatever builds images fetches their base from elsewhere.
        patch.setattr(artifacts, "ENGINES", ())
        # Translations are owed until a release; test_release_refusals.py proves that they are then.
        patch.setattr("release.__main__.untranslated", lambda root: ())
        make(copy, VERSION, DAY, dry_run=False)
    return copy


@pytest.fixture(scope="package")
def made(sources: Path) -> Path:
    """Return the folder of what the release consists of."""
    return sources / "dist" / VERSION


@pytest.fixture(scope="package")
def installed(made: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where the wheel of the release is installed."""
    target = tmp_path_factory.mktemp("installed")
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index"]
    wheel = made / f"heliopanel-{VERSION}-py3-none-any.whl"
    subprocess.run(
        [*command, "--no-deps", "--target", str(target), str(wheel)], check=True, capture_output=True
    )
    return target


@pytest.fixture(scope="module")
def served(installed: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Product, int]]:
    """Serve it from a folder that has nothing but a trap: another package of the same name.

    Return it with the port of its SunSpec server.
    """
    port = free_port()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("elsewhere"))
        Path("app").mkdir()
        Path("app", "__init__.py").write_text(ANOTHER_APP)
        patch.setenv("PYTHONPATH", os.pathsep.join([str(installed), os.environ.get("PYTHONPATH", "")]))
        patch.setattr(serving, "COMMAND", str(installed / "bin" / "heliopanel"))
        running = Product.start(Path("data").resolve(), sunspec_port=str(port))
        yield running, port
        assert running.stop() == 0
