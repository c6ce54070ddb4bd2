"""`deploy/install.sh` under a folder: real environments and real pip, a small wheel in place of ours."""

import hashlib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[3] / "deploy" / "install.sh"
PROGRAM = """
import os, pathlib, sys

def main():
    settings = pathlib.Path(os.environ["HELIOPANEL_CONFIG"]).read_text()
    if sys.argv[1:3] == ["config", "check"] and "wrong = 1" in settings:
        sys.exit("wrong is wrong.")
    if sys.argv[1] == "restore":
        pathlib.Path(os.environ["HELIOPANEL_DATA_DIR"], "heliopanel.db").write_text("restored by {version}")
    if sys.argv[1] == "backup":
        target = pathlib.Path(sys.argv[2])
        target.parent.mkdir(exist_ok=True)
        target.write_text("{version}")
"""
WANTS = "Requires-Dist: small-sun>=1\nProvides-Extra: pdf\nRequires-Dist: small-pen; extra == 'pdf'\n"


def wheel(folder: Path, name: str, version: str, more: str = "", program: str = "") -> Path:
    """Make a wheel; with a program it brings the command heliopanel."""
    module, path = name.replace("-", "_"), folder / f"{name.replace('-', '_')}-{version}-py3-none-any.whl"
    info = f"{module}-{version}.dist-info"
    files = {
        f"{module}_code.py": program,
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n{more}",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: tests\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    if program:
        files[f"{info}/entry_points.txt"] = f"[console_scripts]\nheliopanel = {module}_code:main\n"
    files[f"{info}/RECORD"] = "".join(f"{file},,\n" for file in [*files, f"{info}/RECORD"])
    with zipfile.ZipFile(path, "w") as archive:
        for file, text in files.items():
            archive.writestr(file, text)
    return path


class Computer:
    """A folder in place of a computer's root, and another with what could be downloaded."""

    def __init__(self, folder: Path) -> None:
        self.root, self.shelf, self.lock = folder / "root", folder / "shelf", folder / "requirements.txt"
        self.root.mkdir()
        self.shelf.mkdir()
        libraries = [wheel(self.shelf, name, "1.5") for name in ("small-sun", "small-pen", "not-asked-for")]
        self.lock.write_text(
            "".join(
                f"{path.name.split('-')[0].replace('_', '-')}==1.5 \\\n"
                f"    --hash=sha256:{hashlib.sha256(path.read_bytes()).hexdigest()}\n"
                for path in libraries
            )
        )
        self.programs = self.root / "opt/heliopanel"
        self.data = self.root / "var/lib/heliopanel"
        self.settings = self.root / "etc/heliopanel/heliopanel.toml"
        self.python = sys.executable

    def run(self, *given: str | Path) -> subprocess.CompletedProcess[str]:
        """Run the script as an impatient person would: nobody is asked anything."""
        command = ["sh", SCRIPT, "--root", self.root, *given]
        clean = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "PYTHON"))}
        return subprocess.run(
            command, env=clean, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False
        )

    def install(self, version: str, *more: str) -> subprocess.CompletedProcess[str]:
        """Install a version from the shelf."""
        made = wheel(self.shelf, "heliopanel", version, WANTS, PROGRAM.replace("{version}", version))
        options = ("--wheels", self.shelf, "--lock", self.lock, "--python", self.python)
        return self.run(*options, *more, made)

    @property
    def versions(self) -> list[str]:
        """Return which versions lie there."""
        return sorted(path.name.split("-")[0] for path in self.programs.glob("*") if path.name != "current")

    @property
    def current(self) -> str:
        """Return the version that the units start."""
        return (self.programs / "current").readlink().name.split("-")[0]

    @property
    def libraries(self) -> set[str]:
        """Return the libraries of the version that the units start."""
        found = (self.programs / "current/lib").glob("python*/site-packages/*_code.py")
        return {path.stem.removesuffix("_code") for path in found}


@pytest.fixture
def computer(tmp_path: Path) -> Computer:
    return Computer(tmp_path)


@pytest.fixture(scope="module")
def quick_python(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return a Python that copies an environment instead of making one anew, which takes most of the time."""
    here = tmp_path_factory.mktemp("python")
    subprocess.run([sys.executable, "-m", "venv", here / "made"], check=True)
    program = here / "python3"
    program.write_text(
        f'#!/bin/sh\n[ "$1 $2" != "-m venv" ] || exec cp -R {here}/made "$3"\nexec {sys.executable} "$@"\n'
    )
    program.chmod(0o755)
    return str(program)


@pytest.mark.timeout(300)
def test_it_installs_upgrades_and_takes_away(computer: Computer) -> None:
    done = computer.install("1.0")
    assert done.returncode == 0, done.stderr
    assert (computer.versions, computer.current) == (["1.0"], "1.0")
    assert computer.libraries == {"heliopanel", "small_sun"}
    assert computer.data.stat().st_mode & 0o777 == 0o700
    assert computer.settings.stat().st_mode & 0o777 == 0o640
    for unit in ("heliopanel-controller", "heliopanel-web"):
        text = (computer.root / f"etc/systemd/system/{unit}.service").read_text()
        assert "ExecStart=/opt/heliopanel/current/bin/heliopanel " in text
    assert os.access(computer.root / "usr/local/bin/heliopanel", os.X_OK)
    assert computer.run("--remove").returncode == 0
    left = {str(path.relative_to(computer.root)) for path in computer.root.rglob("*") if not path.is_dir()}
    assert left == {"etc/heliopanel/heliopanel.toml"}
    assert computer.data.is_dir()
    assert computer.run("--remove", "--purge").returncode == 0
    assert not computer.data.exists()
    assert not computer.settings.parent.exists()


@pytest.mark.timeout(300)
def test_an_upgrade_keeps_settings_extras_a_backup_and_one_version(
    computer: Computer, quick_python: str
) -> None:
    computer.python = quick_python
    assert computer.install("1.0", "--extras", "pdf").returncode == 0
    computer.settings.write_text("port = 8001\n")
    (computer.data / "machine.lock").touch()
    (computer.programs / "0.9-20260101T000000").mkdir()
    former = computer.root / "etc/systemd/system/heliopanel-machine.service"
    former.touch()
    done = computer.install("1.1")
    assert done.returncode == 0, done.stderr
    assert not former.exists(), "two controller services would contend for the drives"
    assert (computer.versions, computer.current) == (["1.0", "1.1"], "1.1")
    assert computer.libraries == {"heliopanel", "small_sun", "small_pen"}
    assert computer.settings.read_text() == "port = 8001\n"
    (kept,) = (computer.data / "backups").glob("before-1.1-*.db")
    assert kept.read_text() == "1.0", "the version before writes it"
    assert computer.install("1.0", "--restore", str(kept)).returncode == 0
    assert (computer.versions, computer.current) == (["1.0", "1.1"], "1.0")
    assert (computer.data / "heliopanel.db").read_text() == "restored by 1.0"


@pytest.mark.timeout(300)
def test_what_goes_wrong_is_one_sentence_and_changes_nothing(computer: Computer, quick_python: str) -> None:
    computer.python = quick_python
    computer.settings.parent.mkdir(parents=True)
    computer.settings.write_text("wrong = 1\n")
    done = computer.install("1.1")
    assert done.returncode == 2
    assert done.stderr == (
        "wrong is wrong.\nheliopanel: The settings are not right for version 1.1; nothing was changed.\n"
    )
    (computer.shelf / "small_sun-1.5-py3-none-any.whl").unlink()
    wheel(computer.shelf, "small-sun", "1.5", program="'another file under the same name'")
    done = computer.install("1.2")
    assert done.returncode == 1
    assert "DO NOT MATCH THE HASHES" in done.stderr
    assert done.stderr.endswith("heliopanel: The libraries could not be installed; nothing was changed.\n")
    computer.lock.write_text("not-asked-for==1.5 --hash=sha256:0\n")
    done = computer.install("1.3")
    assert done.returncode == 2
    assert "The lock does not name small-sun.\n" in done.stderr
    assert computer.versions == []
    assert not (computer.root / "etc/systemd").exists()


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (("--purge",), "--purge goes with --remove."),
        (("--frobnicate",), "There is no option --frobnicate. See --help."),
        (("--lock",), "--lock needs a value."),
        (("--python", "no-such-python"), "There is no no-such-python. Install it with: apt-get"),
        (("gone.whl",), "There is no file gone.whl."),
        (("--restore", "gone.db"), "There is no file gone.db."),
        (("--wheels", "no-such-folder"), "There is no folder no-such-folder."),
    ],
)
def test_a_wrong_word_is_one_sentence(computer: Computer, given: tuple[str, ...], says: str) -> None:
    done = computer.run(*given)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert done.stderr.startswith(f"heliopanel: {says}")


def test_a_checkout_in_the_way_is_not_removed(computer: Computer) -> None:
    (computer.programs / ".git").mkdir(parents=True)
    done = computer.run("--remove", "--purge")
    assert done.returncode == 2
    assert "is a checkout of the project. Move it away first." in done.stderr
    assert (computer.programs / ".git").is_dir()
