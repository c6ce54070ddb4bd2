"""`make gate`: the last commit, and no more than it, is run in a clone; only what passed is green."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
AUTHOR = {
    "GIT_AUTHOR_NAME": "Test", "GIT_AUTHOR_EMAIL": "test@example.invalid",
    "GIT_COMMITTER_NAME": "Test", "GIT_COMMITTER_EMAIL": "test@example.invalid",
}  # fmt: skip
PASSES = "echo all of it passed; mkdir -p build; echo tests/test_late.py::test_late > build/flaky.txt\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Return a folder under git, in which build/ is not."""
    (tmp_path / ".gitignore").write_text("/build/\n")
    subprocess.run(["git", "init", "--quiet", tmp_path], check=True)
    return tmp_path


def committed(project: Path, run: str) -> str:
    """Commit what `.ci/run` does, and return the commit."""
    (project / ".ci").mkdir(exist_ok=True)
    (project / ".ci" / "run").write_text(run)
    for command in (["add", "--all"], ["commit", "--quiet", "--message", "test"], ["rev-parse", "HEAD"]):
        done = subprocess.run(
            ["git", *command], cwd=project, env=AUTHOR, capture_output=True, text=True, check=True
        )
    return done.stdout.strip()


def gate(project: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tools.clean_gate"]
    given = {"PYTHONPATH": str(ROOT), "VIRTUAL_ENV": "/of/the/caller", "PATH": "/usr/bin:/bin"}
    return subprocess.run(command, cwd=project, env=given, capture_output=True, text=True, check=False)


def test_a_commit_that_passes_is_green_and_one_that_fails_leaves_it_so(project: Path) -> None:
    good = committed(project, PASSES + 'test -z "${PYTHONPATH:-}${VIRTUAL_ENV:-}"\n')
    done = gate(project)
    assert done.returncode == 0, done.stdout + done.stderr
    green = json.loads((project / "build" / "green").read_text())
    assert green.keys() == {"commit", "seconds", "processor_seconds", "passed_only_alone"}
    assert (green["commit"], green["passed_only_alone"]) == (good, ["tests/test_late.py::test_late"])
    bad = committed(project, "echo no; exit 3\n")
    done = gate(project)
    assert done.returncode == 3
    assert f"Commit {bad} does not pass" in done.stdout
    assert json.loads((project / "build" / "green").read_text())["commit"] == good


def test_what_is_not_committed_is_no_part_of_it(project: Path) -> None:
    committed(project, PASSES)
    (project / ".ci" / "run").write_text("exit 1\n")
    done = gate(project)
    assert done.returncode == 0
    assert "What is not committed is not part of this run." in done.stdout
