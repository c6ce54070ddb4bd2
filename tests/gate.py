"""Run the tests, and those that fail once more, alone: only what fails twice is a failure.

`make test` calls it with pytest's arguments. What passed only alone depends on how busy the computer is:
the last line names it, and `build/flaky.txt` collects it, until its cause is mended. The exit code is
pytest's.
"""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

LAST_FAILED = Path(".pytest_cache/v/cache/lastfailed")
FLAKY = Path("build/flaky.txt")
MOST = 25
"""More failures than this are no chance, and to repeat them would take long."""


def ran(*arguments: str) -> int:
    """Run pytest in a process of its own, and return its exit code."""
    return subprocess.run([sys.executable, "-m", "pytest", *arguments], check=False).returncode


def failed() -> list[str]:
    """Return the tests that failed in the run that has just ended."""
    return sorted(json.loads(LAST_FAILED.read_text())) if LAST_FAILED.exists() else []


def main(arguments: Sequence[str]) -> int:
    """Return 0 if each test passed, together with the others or alone."""
    code = ran("--cache-clear", *arguments)
    again = failed()
    if code != pytest.ExitCode.TESTS_FAILED or not again:
        return code
    if len(again) > MOST:
        print(f"{len(again)} tests failed, too many to repeat alone.")
        return code
    print(f"Running alone what failed: {', '.join(again)}", flush=True)
    code = ran(*again)
    if code:
        return code
    FLAKY.parent.mkdir(exist_ok=True)
    with FLAKY.open("a") as file:
        file.writelines(f"{test}\n" for test in again)
    print(f"{len(again)} passed only alone: {', '.join(again)}")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
