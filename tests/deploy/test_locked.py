"""How locks are installed: by uv as pip is set up, or by pip; and what does not fit together is told."""

import hashlib
import subprocess
import venv
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pip
import pytest

from deploy import locked

LISTED = """\
:env:.cert='/etc/ssl/of-the-environment.crt'
:env:.default-timeout='180'
global.cert='/etc/ssl/global.crt'
global.constraint='/etc/pip/constraints.txt'
global.extra-index-url='file:///srv/one/simple file:///srv/two/simple'
install.no-index='true'
user.index-url='http://127.0.0.1:3141/root/pypi/+simple/'
user.trusted-host='\\n127.0.0.1\\nlocalhost'
wheel.find-links='/not/for/install'
"""


def test_uv_is_given_the_settings_of_pip() -> None:
    settings = locked.settings_of_pip(LISTED)
    assert " ".join(locked.options(settings)[3:]) == (
        "--default-index http://127.0.0.1:3141/root/pypi/+simple/ "
        "--index file:///srv/one/simple --index file:///srv/two/simple "
        "--allow-insecure-host 127.0.0.1 --allow-insecure-host localhost --no-index"
    )
    assert locked.environment(settings, {}) == {
        "SSL_CERT_FILE": "/etc/ssl/of-the-environment.crt",
        "UV_HTTP_TIMEOUT": "180",
    }
    assert locked.environment({"timeout": "180"}, {"UV_HTTP_TIMEOUT": "5"}) == {"UV_HTTP_TIMEOUT": "5"}


def wheel(shelf: Path, name: str, requires: str = "") -> str:
    """Put a wheel with nothing in it on the shelf, and return its line of a lock."""
    path, info = shelf / f"{name}-1.0-py3-none-any.whl", f"{name}-1.0.dist-info"
    needs = f"Requires-Dist: {requires}\n" if requires else ""
    with zipfile.ZipFile(path, "w") as file:
        file.writestr(f"{name}.py", "")
        file.writestr(f"{info}/METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n{needs}")
        file.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        file.writestr(f"{info}/RECORD", f"{name}.py,,\n{info}/METADATA,,\n{info}/WHEEL,,\n{info}/RECORD,,\n")
    return f"{name}==1.0 --hash=sha256:{hashlib.sha256(path.read_bytes()).hexdigest()}\n"


@dataclass
class Place:
    """An environment of its own, and a shelf of wheels: the only place that anything is taken from."""

    folder: Path
    lock: str = ""

    @property
    def python(self) -> Path:
        return self.folder / "venv" / "bin" / "python"

    def made(self, *, uv: bool) -> "Place":
        """Make the environment as `python -m venv` does, but with the pip, and the uv, of this one."""
        (self.folder / "shelf").mkdir()
        venv.create(self.folder / "venv", symlinks=True)
        site = next((self.folder / "venv" / "lib").glob("python*/site-packages"))
        (site / "pip").symlink_to(Path(pip.__file__).parent)
        if uv:
            self.python.with_name("uv").symlink_to(locked.UV)
        return self

    def holds(self, name: str, requires: str = "") -> None:
        self.lock += wheel(self.folder / "shelf", name, requires)

    def installed(self) -> subprocess.CompletedProcess[str]:
        """Install the lock as the Makefile does."""
        lock = self.folder / "lock.txt"
        lock.write_text(self.lock)
        given = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(self.folder / "shelf"), "HOME": str(self.folder)}
        command = [self.python, locked.__file__, str(lock)]
        return subprocess.run(command, env=given, capture_output=True, text=True, check=False)

    def has(self, name: str) -> bool:
        return any((self.folder / "venv" / "lib").glob(f"python*/site-packages/{name}.py"))


@pytest.mark.parametrize("installer", ["uv", "pip"])
def test_a_lock_is_installed_without_resolving_it(installer: str, tmp_path: Path) -> None:
    place = Place(tmp_path).made(uv=installer == "uv")
    place.holds("first")
    place.holds("second", requires="first")
    done = place.installed()
    assert done.returncode == 0, done.stderr
    assert (place.has("first"), place.has("second")) == (True, True)
    assert ("with pip" in done.stdout) == (installer == "pip")


def test_a_file_with_another_checksum_is_refused(tmp_path: Path) -> None:
    place = Place(tmp_path).made(uv=True)
    place.holds("first")
    place.lock = place.lock[:-9] + "00000000\n"
    assert place.installed().returncode == 1
    assert not place.has("first")


def test_libraries_that_do_not_fit_together_are_told(tmp_path: Path) -> None:
    place = Place(tmp_path).made(uv=True)
    place.holds("second", requires="first>=2")
    done = place.installed()
    assert done.returncode == 1
    assert "first" in done.stderr
    assert "Remove" in done.stderr.splitlines()[-1]
