"""Run the gate as another computer runs it: `.ci/run` in a clone of the last commit, for `make gate`.

If all of it passes, `build/green` says which commit, and how long it took; else it stays what it was, and the
clone stays in `build/gate`. What was printed is in `build/gate.log`.
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

BUILD = Path("build")
CLONE, LOG, GREEN = BUILD / "gate", BUILD / "gate.log", BUILD / "green"
OWN = ("VIRTUAL_ENV", "PYTHONPATH", "PYTHONHOME", "MAKEFLAGS", "MAKELEVEL", "MFLAGS")
"""What a command in this folder sets for itself, and a new computer does not have."""


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], capture_output=True, text=True, check=True).stdout.strip()


def run_in_clone(command: str) -> int:
    """Run a command of the clone, show and keep what it prints, and return its exit code."""
    given = {name: value for name, value in os.environ.items() if name not in OWN}
    process = subprocess.Popen(
        ["bash", command], cwd=CLONE, env=given, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    with LOG.open("w") as log:
        for line in process.stdout:
            print(line, end="", flush=True)
            log.write(line)
    return process.wait()


def main() -> int:
    """Return 0 if the last commit passes."""
    BUILD.mkdir(exist_ok=True)
    if git("status", "--porcelain"):
        print("What is not committed is not part of this run.", flush=True)
    commit = git("rev-parse", "HEAD")
    shutil.rmtree(CLONE, ignore_errors=True)
    git("clone", "--quiet", ".", str(CLONE))
    begun_s = time.monotonic()
    code = run_in_clone(".ci/run")
    if code:
        print(f"Commit {commit} does not pass: the end of {LOG} says why.")
        return code
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = {
        "commit": commit,
        "seconds": round(time.monotonic() - begun_s),
        "processor_seconds": round(used.ru_utime + used.ru_stime),
        "passed_only_alone": _lines(CLONE / "build" / "flaky.txt"),
    }
    GREEN.write_text(json.dumps(took, indent=2) + "\n")
    shutil.rmtree(CLONE)
    print(f"{GREEN}: {GREEN.read_text()}", end="")
    return 0


def _lines(file: Path) -> list[str]:
    return file.read_text().splitlines() if file.exists() else []


if __name__ == "__main__":
    sys.exit(main())
