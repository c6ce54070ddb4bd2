"""Measure, print, and renew what is measured in docs/develop/benchmarks.md: `python -m bench [NAME ...]`."""

import argparse
import importlib
import os
import pkgutil
import platform
import re
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import bench
from bench.table import NotMeasured, Row

REPORT = Path(__file__).resolve().parents[1] / "docs" / "develop" / "benchmarks.md"
NOT_BENCHMARKS = {"__main__", "table"}

HEAD = """# Benchmarks

`make bench` runs every section below and writes this page; each section has its date, place, and commit. A
time holds only within its own run: compare how many times better ours is than the bound or than the peer of
the same run. From 1 on this is good, in every row; a row below its bound says **missed**, one below its peer
**behind**. A p99.9 is given for a thousand values or more, otherwise the maximum.
Every row names its command.
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
        f"Measured on {datetime.now(UTC).date()} at commit {commit()}, {where}{_priority()}.",
        "",
        "| what | ours | bound or peer | times better | command |",
        "| --- | --- | --- | --- | --- |",
    ]
    lines += [
        f"| {row.name} | {row.ours} | {row.against} | {row.verdict} | `{row.command}` |" for row in rows
    ]
    return "\n".join(lines) + "\n"


def commit() -> str:
    """Return the commit that is measured, and whether something was changed since."""
    asked = (
        "git",
        "-C",
        str(REPORT.parent),
        "describe",
        "--always",
        "--dirty=, changed since",
        "--exclude=*",
    )
    told = subprocess.run(asked, capture_output=True, text=True)
    return told.stdout.strip() or "unknown"


def _priority() -> str:
    """Return what is to be known of who measured: as root the controller gets real-time scheduling."""
    return "; as root, so that controller and web process ran in real time" if os.geteuid() == 0 else ""


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
