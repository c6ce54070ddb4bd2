"""`python -m checks NAME ...` tells every fault in a sentence, with what mends it, and fails."""

import sys
from collections.abc import Callable, Iterator
from importlib import import_module

NAMES = ("clocks", "documents", "generated", "sources", "texts", "api")


def main(names: list[str]) -> int:
    """Look for the faults of these checks, of all without a name, and return the exit code."""
    found = []
    for name in names or NAMES:
        faults: Callable[[], Iterator[str]] = import_module(f"checks.{name}").faults
        found += faults()
    sys.stdout.writelines(f"{fault}\n" for fault in found)
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
