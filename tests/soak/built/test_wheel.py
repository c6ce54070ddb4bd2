"""The product as it is installed: built as sdist and wheel, put into a folder, served from an empty one."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest

from app.base.build import VERSION
from app.store.connections import reading_engine, revision_of
from app.store.tables import REVISION
from app.web.features.guide.guide import TITLES
from bench.installed import BOUND_MB, MEGABYTE, OWN, installation
from tests.e2e import product
from tests.e2e.product import Product

ROOT = Path(__file__).resolve().parents[3]
SOURCES = (
    *("CHANGELOG.md", "LICENSE", "MANIFEST.in", "README.md", "SECURITY.md", "alembic", "alembic.ini", "app"),
    *("docs", "pyproject.toml", "setup.py", "static", "templates"),
)
BUILD_SDIST = "import sys; from setuptools.build_meta import build_sdist; print(build_sdist(sys.argv[1]))"
PIP = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", "--no-cache-dir")
LEADS_TO = re.compile(r'(?:href|src|srcset|data-src)="(/[^"#\s]*)')
SEEDS = ("/", "/site", "/trackers/T1", "/guide", "/guide/operators-guide")
PATIENCE_S = 60.0
NOT_YET = 409
"""A page that wants a commissioned tracker."""
ANOTHER_APP = 'raise SystemExit("The folder that this was started in has an app of its own.")'


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where the wheel of the sdist of these sources is installed."""
    here = tmp_path_factory.mktemp("wheel")
    sources, wheels, target = here / "sources", here / "wheels", here / "installed"
    sources.mkdir()
    for name in SOURCES:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, sources / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(ROOT / name, sources / name)
    run(sys.executable, "-m", "tools.manual", str(sources / "manual"), cwd=ROOT)
    (sources / "build" / "lib" / "app").mkdir(parents=True)
    (sources / "build" / "lib" / "app" / "gone.py").touch()
    run(sys.executable, "-c", BUILD_SDIST, str(wheels), cwd=sources)
    made = wheels / f"heliopanel-{VERSION}.tar.gz"
    run(
        *PIP,
        "wheel",
        "--no-index",
        "--no-build-isolation",
        "--no-deps",
        "-w",
        str(wheels),
        str(made),
        cwd=here,
    )
    wheel = wheels / f"heliopanel-{VERSION}-py3-none-any.whl"
    run(*PIP, "install", "--no-index", "--no-deps", "--target", str(target), str(wheel), cwd=here)
    return target


@pytest.fixture(scope="module")
def served(installed: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Product]:
    """Serve it from a folder that has nothing but a trap: another package of the same name."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("elsewhere"))
        Path("app").mkdir()
        Path("app", "__init__.py").write_text(ANOTHER_APP)
        patch.setenv("PYTHONPATH", os.pathsep.join([str(installed), os.environ["PYTHONPATH"]]))
        patch.setattr(product, "COMMAND", str(installed / "bin" / "heliopanel"))
        running = Product.start(Path("data").resolve())
        yield running
        assert running.stop() == 0


def run(*command: str, cwd: Path) -> str:
    """Run a command to its end and return what it printed; what it complained of is in the failure."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, timeout=110)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_nothing_of_the_checkout_is_needed(installed: Path) -> None:
    told = "from app.base import build, own; print(*map(own.own_folder, %r.split()), build.VERSION)"
    folders = "alembic docs static templates"
    environment = os.environ | {"PYTHONPATH": str(installed)}
    done = subprocess.run(
        [sys.executable, "-P", "-c", told % folders],
        cwd=installed, env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    carried = installed / "app" / "_carried"
    assert done.stdout.split() == [*(str(carried / name) for name in folders.split()), VERSION]
    assert not (installed / "alembic").exists()


def test_with_its_libraries_it_takes_no_more_than_240_mb(installed: Path) -> None:
    libraries = sum(one.size for name, one in installation().items() if name != OWN)
    own = sum(path.stat().st_blocks * 512 for path in installed.rglob("*") if path.is_file())
    assert libraries + own < BOUND_MB * MEGABYTE
    assert not (installed / "app" / "_carried" / "manual" / "pictures" / "homing-1024.png").exists()


def test_the_pages_and_all_that_they_load_and_lead_to_are_served(served: Product) -> None:
    with httpx.Client(base_url=served.url, follow_redirects=True, timeout=PATIENCE_S) as browser:
        found = {place for seed in SEEDS for place in LEADS_TO.findall(browser.get(seed).text)}
        places = sorted({urlsplit(one).path for one in found} | {f"/guide/{name}" for name in TITLES})
        missing = [place for place in places if browser.get(place).status_code not in (200, NOT_YET)]
    assert not missing
    assert {"/s/" in place for place in places} == {True, False}
    assert "/guide/pictures/" in " ".join(places)


def test_the_manual_is_served_offline(served: Product) -> None:
    with httpx.Client(base_url=served.url, timeout=PATIENCE_S) as browser:
        front = browser.get("/manual/")
        loaded = re.findall(r'(?:href|src)="(?:\./)?(assets/[^"]+|manual\.css)"', front.text)
        loaded += ["pictures/homing-1024.png", "openapi.json"]
        answers = {name: browser.get(f"/manual/{name}").status_code for name in loaded}
    assert "Heliopanel" in front.text
    assert set(answers.values()) == {200}
    assert len(answers) > 4


def test_it_speaks_languages_and_prints(served: Product) -> None:
    with httpx.Client(base_url=served.url, timeout=PATIENCE_S) as browser:
        german = browser.get("/", headers={"Accept-Language": "de"})
        assert 'lang="de"' in german.text
        assert "Anlage" in german.text
        paper = browser.get("/api/v1/trackers/T1/record?format=pdf")
        assert paper.content.startswith(b"%PDF"), paper.text
        health = browser.get("/health").json()
    assert health["version"] == VERSION


def test_the_database_is_made(served: Product) -> None:
    engine = reading_engine(f"sqlite:///{served.data_dir / 'heliopanel.db'}")
    with engine.connect() as connection:
        assert revision_of(connection) == REVISION
    engine.dispose()


def test_the_command_tells_of_what_runs(served: Product, tmp_path: Path) -> None:
    options = ["--data-dir", str(served.data_dir)]
    asked = os.environ | {"HELIOPANEL_PORT": str(served.port)}
    told = [
        subprocess.run([product.COMMAND, *words, *options], env=asked, capture_output=True, text=True)
        for words in (["status"], ["diagnostics", str(tmp_path / "told.zip")], ["config", "check"], ["serve"])
    ]
    assert [one.returncode for one in told] == [0, 0, 0, 2]
    assert f"Panel: answers at {served.url}\nT1 Tracker 1: " in told[0].stdout
    with zipfile.ZipFile(tmp_path / "told.zip") as archive:
        assert {"site.json", "metrics.json", "journal.json"} <= set(archive.namelist())
    assert "Address already in use" in told[3].stderr
    assert told[3].stderr.count("\n") == 1
