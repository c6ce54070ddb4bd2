"""SECURITY.md names tests that exist, and the source holds what it says of itself."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.secret_search import findings

ROOT = Path(__file__).resolve().parents[1]
ROW = re.compile(
    r"^\| ((?:CR )?\d[^|]*)\| (met|met in part|not met|not applicable) \| ([^|]+) \|$", re.MULTILINE
)
NAMED = re.compile(r"`(test_\w+)`")


def existing() -> set[str]:
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    return {name for text in texts for name in re.findall(r"def (test_\w+)\(", text)}


def test_every_named_test_exists() -> None:
    text = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    named = set(NAMED.findall(text))
    assert len(named) > 30
    assert named - existing() == set()


def test_every_requirement_is_judged_and_says_how() -> None:
    text = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    rows = ROW.findall(text)
    lines = [line for line in text.splitlines() if re.match(r"\| (CR )?\d", line)]
    assert len(rows) == len(lines) > 60
    assert all(how.strip() for _, _, how in rows)


def calls(path: Path) -> Iterator[ast.Call]:
    yield from (node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Call))


def test_the_source_runs_no_shell() -> None:
    for path in (ROOT / "app").rglob("*.py"):
        for call in calls(path):
            assert not any(one.arg == "shell" for one in call.keywords), path
            assert ast.unparse(call.func) not in {"os.system", "os.popen", "eval", "exec"}, path


def test_no_secret_lies_in_the_repository() -> None:
    assert findings(ROOT) == []


@pytest.mark.parametrize(
    "planted",
    [
        "-----BEGIN EC " + "PRIVATE KEY-----",
        "password = " + '"correct-horse-battery"',
        "hp_" + "a1b2c3d4" * 6,
        "AKIA" + "IOSFODNN7EXAMPLE",
        "mqtts://user:" + "s3cretpw@broker.example",
    ],
)
def test_a_planted_secret_is_found(tmp_path: Path, planted: str) -> None:
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    (tmp_path / "settings.txt").write_text(f"first\n{planted}\n")
    subprocess.run(["git", "-C", str(tmp_path), "add", "settings.txt"], check=True)
    assert [(one.path, one.line) for one in findings(tmp_path)] == [("settings.txt", 2)]
    told = subprocess.run(
        [sys.executable, "-m", "tests.secret_search", str(tmp_path)], cwd=ROOT, capture_output=True, text=True
    )
    assert told.returncode == 1
    assert planted not in told.stdout
