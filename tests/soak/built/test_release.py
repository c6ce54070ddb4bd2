"""A release, made in copies of these sources: one version everywhere, the same bytes twice, or nothing."""

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, date, datetime, time
from email.parser import HeaderParser
from pathlib import Path

import httpx
import pytest
from pymodbus.client import ModbusTcpClient

from app.store.connections import reading_engine, transaction
from app.store.software import version_of
from release import artifacts
from release.__main__ import git, make, present_version
from tests.e2e.product import Product
from tests.ports import free_port

ROOT = Path(__file__).resolve().parents[3]
VERSION, DAY = "9.9.0", date(2030, 5, 17)
pytestmark = pytest.mark.timeout(400)
MADE_AT = datetime.combine(DAY, time(), UTC)
NEWS = "- The panel whistles."
HOSTS = re.compile(r"\b(?:https?|ftp)://(?!cyclonedx\.org/schema/)")


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


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy in which the release was made."""
    copy = copied(tmp_path_factory.mktemp("sources"))
    with pytest.MonkeyPatch.context() as patch:
        # Whatever builds images fetches their base from elsewhere.
        patch.setattr(artifacts, "ENGINES", ())
        make(copy, VERSION, DAY, dry_run=False)
    return copy


@pytest.fixture(scope="module")
def made(sources: Path) -> Path:
    """Return the folder of what the release consists of."""
    return sources / "dist" / VERSION


def test_it_is_committed_and_tagged_and_nothing_else_changed(sources: Path) -> None:
    assert git(sources, "status", "--porcelain") == ""
    assert git(sources, "log", "-1", "--format=%s %D") == f"release: {VERSION} HEAD -> main, tag: v{VERSION}"
    assert git(sources, "cat-file", "-t", f"v{VERSION}") == "tag"
    changed = set(git(sources, "diff", "--name-only", "HEAD~1").splitlines())
    assert changed == {"app/base/build.py", "CHANGELOG.md", "docs/openapi.json"}
    assert present_version(sources) == VERSION
    assert "BUILT_AT = datetime(2030, 5, 17, tzinfo=UTC)" in (sources / "app/base/build.py").read_text()
    told = (sources / "CHANGELOG.md").read_text()
    assert f"## [Unreleased]\n\n## [{VERSION}] - 2030-05-17\n\n### Added\n\n{NEWS}\n" in told


def test_all_of_it_is_there_and_the_checksums_are_right(made: Path) -> None:
    names = {one.name for one in made.iterdir()}
    bare = f"heliopanel-{VERSION}"
    wheel = f"{bare}-py3-none-any.whl"
    assert names == {f"{bare}.tar.gz", wheel, f"{bare}.cdx.json", "SHA256SUMS"}
    subprocess.run(
        ["sha256sum", "--check", "--strict", "SHA256SUMS"], cwd=made, check=True, capture_output=True
    )
    with zipfile.ZipFile(made / wheel) as archive:
        about = HeaderParser().parsestr(archive.read(f"{bare}.dist-info/METADATA").decode())
    with tarfile.open(made / f"{bare}.tar.gz") as archive:
        assert {one.name.partition("/")[0] for one in archive.getmembers()} == {bare}
        assert {(one.mtime, one.uid, one.uname) for one in archive.getmembers()} == {
            (MADE_AT.timestamp(), 0, "")
        }
    assert about["Version"] == VERSION


def test_the_same_sources_make_the_same_bytes(
    sources: Path, made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    git(tmp_path, "clone", "--quiet", str(sources), str(tmp_path / "elsewhere"))
    monkeypatch.setattr(artifacts, "ENGINES", ())
    left_out = artifacts.build(tmp_path / "elsewhere", tmp_path / "again", VERSION, MADE_AT)
    for one in (tmp_path / "again").iterdir():
        if one.name != artifacts.CHECKSUMS:
            assert one.read_bytes() == (made / one.name).read_bytes(), one.name
    assert len(left_out) == 1
    assert left_out[0].startswith("The image is left out: ")


@pytest.fixture(scope="module")
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
    """Serve what is installed; return it with the port of its SunSpec server."""
    port = free_port()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(installed), os.environ.get("PYTHONPATH", "")]))
        patch.chdir(tmp_path_factory.mktemp("elsewhere"))
        command = (sys.executable, "-P", "-m", "app.cli")
        running = Product.start(Path("data").resolve(), command=command, sunspec_port=str(port))
        yield running, port
        assert running.stop() == 0


def test_the_one_version_is_told_everywhere(served: tuple[Product, int], tmp_path: Path) -> None:
    product, sunspec = served
    said = subprocess.run(
        [sys.executable, "-P", "-m", "app.cli", "--version"], capture_output=True, text=True, check=True
    )
    assert said.stdout == f"Heliopanel {VERSION}\n"
    with httpx.Client(base_url=product.url, timeout=60.0) as browser:
        assert browser.get("/health").json()["version"] == VERSION
        assert browser.get("/api/v1/health").json()["version"] == VERSION
        assert browser.get("/api/v1/openapi.json").json()["info"]["version"] == VERSION
        assert f">Heliopanel {VERSION}<" in browser.get("/site").text
        assert browser.get("/api/v1/trackers/T1/record").json()["software"] == f"Heliopanel {VERSION}"
        signed = {"role": "technician", "name": "Ada", "strokes": [[[1, 1], [9, 9]]]}
        asked = {"signatures": [signed], "remark": "", "confirmed": True}
        kept = browser.post("/api/v1/trackers/T1/records", json=asked).json()
        document = browser.get(f"/api/v1/records/{kept['number']}").json()
        paper = browser.get(f"/api/v1/records/{kept['number']}?format=html").text
        told = browser.get("/diagnostics.zip").content
    assert f"Heliopanel {VERSION}" in json.dumps(document)
    assert f"Heliopanel {VERSION}" in paper
    (tmp_path / "told.zip").write_bytes(told)
    with zipfile.ZipFile(tmp_path / "told.zip") as archive:
        assert json.loads(archive.read("about.json"))["version"] == VERSION
    assert [line["version"] for line in product.lines if line.get("event") == "machine_ready"] == [VERSION]
    assert noted_in(product.data_dir) == VERSION
    with closing(ModbusTcpClient("127.0.0.1", port=sunspec)) as master:
        assert master.connect()
        words = master.read_holding_registers(40_000, count=70, device_id=1).registers
    assert VERSION.encode() in b"".join(word.to_bytes(2, "big") for word in words)


def noted_in(data: Path) -> str | None:
    """Return which version a database says that it was written by."""
    engine = reading_engine(f"sqlite:///{data / 'heliopanel.db'}")
    with transaction(engine) as connection:
        found = version_of(connection)
    engine.dispose()
    return found


def test_no_other_place_of_the_program_says_a_version(sources: Path) -> None:
    names = git(sources, "grep", "-lF", VERSION).splitlines()
    assert set(names) == {
        "app/base/build.py",
        "CHANGELOG.md",
        "docs/openapi.json",
        "tests/soak/built/test_release.py",
    }
    before = present_version(ROOT)
    found = git(
        sources, "grep", "-lF", f'"{before}"', "--", "app", "templates", "pyproject.toml", "setup.py", "."
    )
    assert not {
        one for one in found.splitlines() if one.startswith(("app/", "templates/", "pyproject", "setup"))
    }


def test_the_bill_has_every_locked_library_and_vendored_package_and_no_host(made: Path) -> None:
    text = (made / f"heliopanel-{VERSION}.cdx.json").read_text()
    parts = {one["name"]: one for one in json.loads(text)["components"]}
    locked = dict(
        re.findall(r"^([\w.-]+)==([^\s;\\]+)", (ROOT / "requirements.txt").read_text(), re.MULTILINE)
    )
    del locked["setuptools"]
    vendored = json.loads((ROOT / "static/vendor/manifest.json").read_text()).values()
    assert {name: parts[name]["version"] for name in locked} == locked
    assert set(parts) == set(locked) | {one["package"] for one in vendored}
    assert all(parts[name]["hashes"] for name in locked)
    assert HOSTS.search(text) is None
    assert json.loads(text)["metadata"]["component"]["version"] == VERSION
