"""Look at the pages that have changed, in Chromium, and stamp those that are good: `make looks`.

`python -m tests.looks` looks at what differs from looked_at.json; `--all` looks at everything, `--only NAME`
at one page. It may be interrupted: a page is stamped as soon as it was found good.
"""

import argparse
import asyncio
import json
import os
import subprocess
import sys

from tests.looks.rendered import everything
from tests.looks.stamp import RULES, Sums, due, kept, put, sums, write


def main() -> int:
    """Return 0 if every page that was looked at is good."""
    parser = argparse.ArgumentParser(prog="python -m tests.looks", description=__doc__)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("-n", default="2")
    asked = parser.parse_args()
    now = sums(asyncio.run(everything()))
    before = kept()
    write({name: codes for name, codes in before.items() if name in now})
    wanted = due(now, {} if asked.all else before)
    if asked.only:
        wanted = {name: codes for name, codes in wanted.items() if name in asked.only}
    if not wanted:
        print("Every page was looked at as it is now.")
        return 0
    print(f"To be looked at: {', '.join(wanted)}", flush=True)
    code = look(now, wanted, asked.n)
    left = due(now, kept())
    if left:
        print("Not stamped: " + ", ".join(f"{name} ({' '.join(codes)})" for name, codes in left.items()))
    return code


def look(now: Sums, wanted: dict[str, list[str]], workers: str) -> int:
    """Run the tests of this folder for these pages; planted faults first, where the rules have changed."""
    told = {name: {code: now[name][code] for code in codes} for name, codes in wanted.items()}
    if RULES in wanted:
        put(RULES, "en", None)
        if code := _pytest({}, "tests/looks/test_planted.py"):
            return code
        put(RULES, "en", now[RULES]["en"])
    return _pytest(told, "tests/looks/test_pages.py", "-n", workers, "--dist", "load", "--tb=line")


def _pytest(told: dict[str, dict[str, str]], *arguments: str) -> int:
    if arguments[0].endswith("test_pages.py") and not told:
        return 0
    environment = os.environ | {"HELIOPANEL_LOOKS": json.dumps(told)}
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    return subprocess.run(command, check=False, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
