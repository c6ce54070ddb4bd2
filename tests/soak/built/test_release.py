"""A release, made in copies of these sources: one version everywhere, the same bytes twice, or nothing."""

import json
import re
import subprocess
import sys
import tarfile
import zipfile
from contextlib import closing
from datetime import UTC, datetime, time
from email.parser import HeaderParser
from pathlib import Path

import httpx
import pytest
from pymodbus.client import ModbusTcpClient

from app.store.connections import reading_engine, transaction
from app.store.software import version_of
from release import artifacts
from release.__main__ import git, present_version
from tests.e2e.product import Product
from tests.soak.built.conftest import DAY, NEWS, ROOT, VERSION

pytestmark = pytest.mark.timeout(400)
MADE_AT = datetime.combine(DAY, time(), UTC)
HOSTS = re.compile(r"\b(?:https?|ftp)://(?!cyclonedx\.org/schema/)")


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
        "tests/soak/built/conftest.py",
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
