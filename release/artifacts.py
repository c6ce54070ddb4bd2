"""What a release consists of: sdist, wheel, bill of materials, image where there is an engine, checksums."""

import gzip
import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
from datetime import datetime
from pathlib import Path

from release.bom import bill

ENGINES = ("podman", "docker")
CONTAINER_FILE = Path("deploy", "Containerfile")
CHECKSUMS = "SHA256SUMS"
BUILD_SDIST = "import sys; from setuptools.build_meta import build_sdist; build_sdist(sys.argv[1])"
PIP_WHEEL = ("pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-index", "--no-build-isolation")
SHARED = 0o022
"""Nobody's own rights of files get into what everybody is given."""


def build(sources: Path, into: Path, version: str, made_at: datetime) -> list[str]:
    """Build everything from a checkout into a folder; return what was left out, and why.

    The same checkout and instant make the same bytes.
    """
    into.mkdir(parents=True)
    before = os.umask(SHARED)
    try:
        _run(sources, made_at, sys.executable, "-m", "tools.manual")
        sdist = _sdist(sources, into, version, int(made_at.timestamp()))
        _run(sources, made_at, sys.executable, "-m", *PIP_WHEEL, "--no-deps", "-w", str(into), str(sdist))
    finally:
        os.umask(before)
    (into / f"heliopanel-{version}.cdx.json").write_text(bill(sources, version, made_at))
    left_out = _image(sources, into, version)
    (into / CHECKSUMS).write_text(checksums(into))
    return left_out


def checksums(folder: Path) -> str:
    """Return the sums of all files as `sha256sum --check` reads them."""
    files = sorted(one for one in folder.iterdir() if one.name != CHECKSUMS)
    return "".join(f"{hashlib.sha256(one.read_bytes()).hexdigest()}  {one.name}\n" for one in files)


def engine() -> str | None:
    """Return the first engine for containers that works on this computer."""
    for name in ENGINES:
        if shutil.which(name) and subprocess.run([name, "info"], capture_output=True).returncode == 0:
            return name
    return None


def _sdist(sources: Path, into: Path, version: str, epoch: int) -> Path:
    _run(sources, None, sys.executable, "-c", BUILD_SDIST, str(into))
    made = into / f"heliopanel-{version}.tar.gz"
    plain = made.with_suffix("")
    with tarfile.open(made) as old, tarfile.open(plain, "w", format=tarfile.GNU_FORMAT) as new:
        for entry in sorted(old.getmembers(), key=lambda one: one.name):
            content = old.extractfile(entry) if entry.isfile() else None
            new.addfile(_nobodys(entry, epoch), content)
    with made.open("wb") as file, gzip.GzipFile("", "wb", mtime=epoch, fileobj=file) as packed:
        packed.write(plain.read_bytes())
    plain.unlink()
    return made


def _nobodys(entry: tarfile.TarInfo, epoch: int) -> tarfile.TarInfo:
    kept = entry.replace(mtime=epoch, uid=0, gid=0, uname="", gname="", deep=False)
    kept.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
    kept.pax_headers = {}
    return kept


def _image(sources: Path, into: Path, version: str) -> list[str]:
    """Build and save the image; return why there is none."""
    if not (sources / CONTAINER_FILE).exists():
        return [f"The image is left out: there is no {CONTAINER_FILE}."]
    command = engine()
    if command is None:
        return [f"The image is left out: no engine works here ({', '.join(ENGINES)})."]
    tag = f"heliopanel:{version}"
    try:
        _run(sources, None, command, "build", "-f", str(CONTAINER_FILE), "-t", tag, ".")
    except subprocess.CalledProcessError:
        return [f"The image is left out: {command} could not build it, as it says above."]
    _run(sources, None, command, "save", "-o", str(into / f"heliopanel-{version}-image.tar"), tag)
    return []


def _run(folder: Path, made_at: datetime | None, *command: str) -> None:
    """Run a command in a folder and print nothing of it unless it fails."""
    dated = {} if made_at is None else {"SOURCE_DATE_EPOCH": str(int(made_at.timestamp()))}
    done = subprocess.run(command, cwd=folder, env=os.environ | dated, capture_output=True, text=True)
    if done.returncode:
        sys.stderr.write(done.stdout + done.stderr)
        done.check_returncode()
