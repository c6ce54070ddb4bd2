"""The product as it is installed: the wheel of a release, put into a folder, served from an empty one."""

import os
import re
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest

from app.store.connections import reading_engine, revision_of
from app.store.tables import REVISION
from app.web.features.guide.guide import TITLES
from bench.installed import BOUND_MB, MEGABYTE, OWN, installation
from tests.e2e import product
from tests.e2e.product import Product
from tests.soak.built.conftest import VERSION

LEADS_TO = re.compile(r'(?:href|src|srcset|data-src)="(/[^"#\s]*)')
SEEDS = ("/", "/site", "/trackers/T1", "/guide", "/guide/operators-guide")
NOT_YET = 409
"""A page that wants a commissioned tracker."""
pytestmark = pytest.mark.timeout(400)


@pytest.fixture
def browser(served: tuple[Product, int]) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=served[0].url, follow_redirects=True, timeout=60.0) as client:
        yield client


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


def test_the_pages_and_all_that_they_load_and_lead_to_are_served(browser: httpx.Client) -> None:
    found = {place for seed in SEEDS for place in LEADS_TO.findall(browser.get(seed).text)}
    places = sorted({urlsplit(one).path for one in found} | {f"/guide/{name}" for name in TITLES})
    missing = [place for place in places if browser.get(place).status_code not in (200, NOT_YET)]
    assert not missing
    assert {"/s/" in place for place in places} == {True, False}
    assert "/guide/pictures/" in " ".join(places)


def test_the_manual_is_served_offline(browser: httpx.Client) -> None:
    front = browser.get("/manual/")
    loaded = re.findall(r'(?:href|src)="(?:\./)?(assets/[^"]+|manual\.css)"', front.text)
    loaded += ["pictures/homing-1024.png", "openapi.json"]
    answers = {name: browser.get(f"/manual/{name}").status_code for name in loaded}
    assert "Heliopanel" in front.text
    assert set(answers.values()) == {200}
    assert len(answers) > 4


def test_it_speaks_languages_and_prints(browser: httpx.Client) -> None:
    german = browser.get("/", headers={"Accept-Language": "de"})
    assert 'lang="de"' in german.text
    assert "Anlage" in german.text
    paper = browser.get("/api/v1/trackers/T1/record?format=pdf")
    assert paper.content.startswith(b"%PDF"), paper.text


def test_the_database_is_made(served: tuple[Product, int]) -> None:
    engine = reading_engine(f"sqlite:///{served[0].data_dir / 'heliopanel.db'}")
    with engine.connect() as connection:
        assert revision_of(connection) == REVISION
    engine.dispose()


def test_the_command_tells_of_what_runs(served: tuple[Product, int], tmp_path: Path) -> None:
    running, _ = served
    options = ["--data-dir", str(running.data_dir)]
    asked = os.environ | {"HELIOPANEL_PORT": str(running.port)}
    told = [
        subprocess.run([product.COMMAND, *words, *options], env=asked, capture_output=True, text=True)
        for words in (["status"], ["diagnostics", str(tmp_path / "told.zip")], ["config", "check"], ["serve"])
    ]
    assert [one.returncode for one in told] == [0, 0, 0, 2]
    assert f"Panel: answers at {running.url}\nT1 Tracker 1: " in told[0].stdout
    with zipfile.ZipFile(tmp_path / "told.zip") as archive:
        assert {"site.json", "metrics.json", "journal.json"} <= set(archive.namelist())
    assert "Address already in use" in told[3].stderr
    assert told[3].stderr.count("\n") == 1
