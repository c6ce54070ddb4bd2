"""Run the tests, and those that fail once more, alone: only what fails twice is a failure.

`make test` calls it with pytest's arguments. Its last lines are what failed, each with its reason, or what
passed only alone, which `build/flaky.txt` collects until its cause is mended; and how long it took. The exit
code is pytest's.
"""

import json
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import pytest

LAST_FAILED = Path(".pytest_cache/v/cache/lastfailed")
BUILD = Path("build")
FLAKY = BUILD / "flaky.txt"
REPORT, REPORT_ALONE = BUILD / "junit.xml", BUILD / "junit-alone.xml"
MOST = 25
"""More failures than this are no chance, and to repeat them would take long."""
LONGEST_REASON = 300


def ran(report: Path, *arguments: str) -> int:
    """Run pytest in a process of its own, and return its exit code."""
    command = [sys.executable, "-m", "pytest", f"--junitxml={report}", *arguments]
    return subprocess.run(command, check=False).returncode


def failed() -> list[str]:
    """Return the tests that failed in the run that has just ended."""
    return sorted(json.loads(LAST_FAILED.read_text())) if LAST_FAILED.exists() else []


def reasons(report: Path) -> list[str]:
    """Return a line for each test that failed: its name, and the first line of its reason."""
    if not report.exists():
        return []
    return [
        f"{case.get('file')}::{case.get('name')}: {_first_line(why)}"
        for case in ElementTree.parse(report).iter("testcase")  # noqa: S314 - pytest has just written it
        for why in [*case.iter("failure"), *case.iter("error")]
    ]


def _first_line(why: ElementTree.Element) -> str:
    said = (why.get("message") or why.text or "").strip()
    return said.partition("\n")[0][:LONGEST_REASON]


def judged(arguments: Sequence[str]) -> int:
    """Return 0 if each test passed, together with the others or alone."""
    code = ran(REPORT, "--cache-clear", *arguments)
    again = failed()
    if code != pytest.ExitCode.TESTS_FAILED or not again:
        return code
    if len(again) > MOST:
        print(f"{len(again)} tests failed, too many to repeat alone:")
        print(*reasons(REPORT), sep="\n")
        return code
    print(f"Running alone what failed: {', '.join(again)}", flush=True)
    code = ran(REPORT_ALONE, *again)
    if code:
        print("Failed, together with the others and alone:", *reasons(REPORT_ALONE), sep="\n")
        return code
    with FLAKY.open("a") as file:
        file.writelines(f"{test}\n" for test in again)
    print(*reasons(REPORT), sep="\n")
    print(f"{len(again)} passed only alone: {', '.join(again)}")
    return code


def main(arguments: Sequence[str]) -> int:
    """Judge the tests, and say how long it took."""
    begun_s = time.monotonic()
    BUILD.mkdir(exist_ok=True)
    code = judged(arguments)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    took_s, used_s = time.monotonic() - begun_s, used.ru_utime + used.ru_stime
    print(f"Tests: {took_s:.0f} s, of which the processor worked {used_s:.0f} s.")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
