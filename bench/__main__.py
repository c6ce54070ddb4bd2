"""Run every benchmark and write docs/benchmarks.md: `python -m bench [NAME ...] [--print]`."""

import argparse
import importlib
import os
import pkgutil
import platform
import sys
from datetime import UTC, datetime
from pathlib import Path

import bench
from bench.table import Row

REPORT = Path(__file__).resolve().parents[1] / "docs" / "benchmarks.md"
NOT_BENCHMARKS = {"__main__", "table"}

HEAD = """# Benchmarks

Made by `make bench` on {date}, {cores} cores ({machine}), Python {python}. A time holds only within its
own run: the ratio to the peer of the same run is what to compare. Every row names its command.
"""


def names() -> list[str]:
    """Return the benchmark modules of this folder."""
    found = {module.name for module in pkgutil.iter_modules(bench.__path__)}
    return sorted(
        name
        for name in found - NOT_BENCHMARKS
        if hasattr(importlib.import_module(f"bench.{name}"), "measure")
    )


def section(name: str, rows: list[Row]) -> str:
    """Return one benchmark's rows as a Markdown table."""
    title = (importlib.import_module(f"bench.{name}").__doc__ or name).strip().splitlines()[0]
    lines = [
        f"\n## {title}\n",
        "| what | ours | peer or bound | ratio | command |",
        "| --- | --- | --- | --- | --- |",
    ]
    lines += [f"| {row.name} | {row.ours} | {row.peer} | {row.ratio} | `{row.command}` |" for row in rows]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Measure what was asked for; without names everything, and write the report."""
    arguments = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    arguments.add_argument("names", nargs="*", help="benchmarks to run (default: all, written to the report)")
    wanted = arguments.parse_args().names or names()
    report = HEAD.format(
        date=datetime.now(UTC).date(),
        cores=os.cpu_count(),
        machine=platform.machine(),
        python=platform.python_version(),
    )
    for name in wanted:
        print(f"measuring {name} ...", file=sys.stderr, flush=True)
        text = section(name, importlib.import_module(f"bench.{name}").measure())
        print(text, flush=True)
        report += text
    if wanted == names():
        REPORT.write_text(report)
        print(f"written: {REPORT.name}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
