"""What decides `make test`: a test that fails is run once more, alone, and judged by that."""

import subprocess
import sys
from pathlib import Path

import pytest

from tools.gate import FLAKY, MOST

ROOT = Path(__file__).resolve().parents[1]
TESTS = """
import os, pathlib, pytest

def first_time(name):
    seen = pathlib.Path(name)
    new = not seen.exists()
    seen.touch()
    return new

@pytest.fixture
def unready():
    assert not first_time("unready")

def test_good():
    pass
"""
ONCE = """
@pytest.mark.parametrize("word", ["two words, [in] brackets"])
def test_once(word):
    assert not first_time("once")

def test_with_what_is_unready(unready):
    pass
"""
TWICE = """
def test_twice():
    raise AssertionError("again")
"""
CRASHES = """
def test_crashes():
    if first_time("crashes"):
        os._exit(3)
"""
MANY = f"""
@pytest.mark.parametrize("number", range({MOST} + 1))
def test_many(number):
    assert not first_time(f"many-{{number}}")
"""


def gate(folder: Path, tests: str, *more: str) -> subprocess.CompletedProcess[str]:
    """Run the gate on a file of tests in a folder of its own."""
    (folder / "pytest.ini").write_text("[pytest]\njunit_family = xunit1\naddopts = -p xdist\n")
    (folder / "test_small.py").write_text(TESTS + tests)
    command = [sys.executable, "-m", "tools.gate", *more]
    environment = {"PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def said(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Return what the gate says at the end, before how long it took."""
    return done.stdout.strip().splitlines()[:-1]


def test_what_passes_alone_is_green_and_named(tmp_path: Path) -> None:
    done = gate(tmp_path, ONCE)
    names = ["test_small.py::test_once[two words, [in] brackets]", "test_small.py::test_with_what_is_unready"]
    assert done.returncode == 0, done.stdout
    assert said(done)[-1] == f"2 passed only alone: {', '.join(names)}"
    assert (tmp_path / FLAKY).read_text().splitlines() == names


def test_a_worker_that_crashed_is_a_failure_of_its_test(tmp_path: Path) -> None:
    done = gate(tmp_path, CRASHES, "-n", "2")
    assert done.returncode == 0, done.stdout
    assert said(done)[-1] == "1 passed only alone: test_small.py::test_crashes"


def test_what_fails_twice_is_red(tmp_path: Path) -> None:
    done = gate(tmp_path, ONCE + TWICE)
    assert done.returncode == pytest.ExitCode.TESTS_FAILED
    why = "test_small.py::test_twice: AssertionError: again"
    assert said(done)[-2:] == ["Failed, together with the others and alone:", why]
    assert not (tmp_path / FLAKY).exists()


@pytest.mark.parametrize(
    ("tests", "arguments", "code"),
    [
        ("import no_such_module", (), pytest.ExitCode.INTERRUPTED),
        ("", ("-k", "nothing_of_it"), pytest.ExitCode.NO_TESTS_COLLECTED),
        (MANY, (), pytest.ExitCode.TESTS_FAILED),
    ],
)
def test_what_chance_does_not_explain_is_not_repeated(
    tests: str, arguments: tuple[str, ...], code: int, tmp_path: Path
) -> None:
    done = gate(tmp_path, tests, *arguments)
    assert done.returncode == code
    assert "Running alone" not in done.stdout
    named = f"{MOST + 1} tests failed, too many to repeat alone:" in said(done)
    assert named == (tests == MANY)
