"""A client made of docs/openapi.json, whole and typed, commissions a tracker of the served product."""

import json
import re
import subprocess
from pathlib import Path

import pytest

from app.web.documented import DOCUMENT
from tests.e2e.product import DriveSim, Product

ROOT = Path(__file__).resolve().parents[3]
WALK = Path(__file__).with_name("client_walk.py")
ENVIRONMENT = ROOT / ".venv" / "client" / "bin"
CONFIG = ROOT / "docs" / "openapi-python-client.yml"
OPERATIONS = 100


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the generated package; a piece that the generator leaves out fails it."""
    made = tmp_path_factory.mktemp("client") / "heliopanel_client"
    generator = ENVIRONMENT / "openapi-python-client"
    assert generator.exists(), "Run: make client"
    told = subprocess.run(
        [generator, "generate", "--path", DOCUMENT, "--config", CONFIG, "--output-path", made,
         "--meta", "none", "--fail-on-warning"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout + told.stderr
    assert "arning" not in told.stdout + told.stderr, told.stdout
    return made


def test_every_operation_and_every_schema_is_generated(package: Path) -> None:
    document = json.loads(DOCUMENT.read_text())
    operations = [one for item in document["paths"].values() for one in item.values()]
    assert len(operations) > OPERATIONS
    assert len([*package.glob("api/*/[!_]*.py")]) == len(operations)
    exported = (package / "models" / "__init__.py").read_text()
    classes = set(re.findall(r"^ {4}\"(\w+)\",$", exported, re.MULTILINE))
    schemas = document["components"]["schemas"]
    assert {name for name in schemas if "_" not in name} <= classes
    titles = [one.get("title", name) for name, one in schemas.items()]
    assert len(titles) == len(set(titles))


def test_it_commissions_a_tracker(package: Path, product: Product, drive: DriveSim) -> None:
    told = subprocess.run(
        [ENVIRONMENT / "python", WALK, package.parent, product.url, str(drive.port)],
        capture_output=True, text=True, check=False, timeout=100,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout + told.stderr
    assert "T1 is commissioned" in told.stdout
