"""Measure, print, and renew the measured sections of docs/benchmarks.md: `python -m bench [NAME ...]`."""

import argparse
import importlib
import os
import pkgutil
import platform
import re
import sys
from datetime import UTC, datetime
from pathlib import Path

import bench
from bench.table import NotMeasured, Row

REPORT = Path(__file__).resolve().parents[1] / "docs" / "benchmarks.md"
NOT_BENCHMARKS = {"__main__", "table"}

HEAD = """# Benchmarks

Made by `make bench`, which runs every section below; each says when and where it was measured. A time
holds only within its own run: the ratio to the peer of the same run is what to compare. Every row names
its command.
"""


def names() -> list[str]:
    """Return the benchmark modules of this folder."""
    found = {module.name for module in pkgutil.iter_modules(bench.__path__)} - NOT_BENCHMARKS
    return sorted(name for name in found if hasattr(importlib.import_module(f"bench.{name}"), "measure"))


def section(name: str, rows: list[Row]) -> str:
    """Return one benchmark's rows as a Markdown table."""
    title = (importlib.import_module(f"bench.{name}").__doc__ or name).split("\n\n")[0].replace("\n", " ")
    where = f"{os.cpu_count()} cores ({platform.machine()}), Python {platform.python_version()}"
    lines = [
        f"## {name}: {title.rstrip('.')}",
        "",
        f"Measured on {datetime.now(UTC).date()}, {where}.",
        "",
        "| what | ours | peer or bound | ratio | command |",
        "| --- | --- | --- | --- | --- |",
    ]
    lines += [f"| {row.name} | {row.ours} | {row.peer} | {row.ratio} | `{row.command}` |" for row in rows]
    return "\n".join(lines) + "\n"


def renewed(report: str, measured: dict[str, str]) -> str:
    """Return the report with these sections in the place of the old ones, in the order of their names."""
    kept = {text.split(":")[0]: f"## {text}" for text in re.split(r"^## ", report, flags=re.MULTILINE)[1:]}
    sections = kept | measured
    return "\n".join([HEAD, *(sections[name].rstrip() + "\n" for name in sorted(sections))])


def main() -> int:
    """Measure what was asked for, without names everything, and renew the report after each that could be."""
    arguments = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    arguments.add_argument("names", nargs="*", help="benchmarks to run (default: all)")
    missing = 0
    for name in arguments.parse_args().names or names():
        print(f"measuring {name} ...", file=sys.stderr, flush=True)
        try:
            text = section(name, importlib.import_module(f"bench.{name}").measure())
        except NotMeasured as why:
            print(f"{name} was not measured: {why}", file=sys.stderr, flush=True)
            missing = 1
            continue
        print(text, flush=True)
        before = REPORT.read_text() if REPORT.exists() else HEAD
        REPORT.write_text(renewed(before, {name: text}))
    return missing


if __name__ == "__main__":
    sys.exit(main())
