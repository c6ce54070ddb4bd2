"""The table of faults: every row with its tests, what they measured, and the page made of their results.

python -m tools.fault_table             run every test that proves a row, and write docs/reference/faults.md
python -m tools.fault_table PART PARTS  run one of so many parts; the page is written once all have passed
"""

import ast
import csv
import json
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import pytest

from tests.fault_result import VIRTUAL

TESTS = Path(__file__).parents[1] / "tests"
GOLDEN = TESTS / "golden" / "fault_table.csv"
PAGE = TESTS.parent / "docs" / "reference" / "faults.md"
PARTS = TESTS.parent / "build" / "faults"

HEAD = """# What can go wrong

Every row of the fault table with what notices it, what follows, what the operator reads and how it ends.
Made by `python -m tools.fault_table` from the results of the tests that each row names; change those, not
this page. Fault, detection and reaction are the design's; the rest is what the tests measured and saw.

*Noticed after* is the time from the fault to its first sign, the longest of several tests: on the virtual
clock with a tick every 0.1 s, or on the real clock, at a real socket, process, disk or page. Where it says
why instead, the product refuses the fault or is immune to it. *Shown* is the sentence that a user was shown
or answered. *Recovery* is what ended the fault in the test; an engineer may set another policy for some
classes of faults, see [decision 0026](../decisions/0026-recovery-is-a-policy.md).

| row | fault | detection | noticed after | reaction | shown | recovery | tests |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of the table, as it was designed."""

    number: int
    fault: str
    detection: str
    reaction: str


@dataclass(slots=True)
class Result:
    """What the tests of one row measured and saw."""

    noticed_s: float | None = None
    noticed_on: str = ""
    prevented: list[str] = field(default_factory=list)
    shown: list[str] = field(default_factory=list)
    recovery: list[str] = field(default_factory=list)

    def take(self, other: "Result") -> None:
        """Take in what more tests said: the longest time, every sentence."""
        if other.noticed_s is not None and other.noticed_s >= (self.noticed_s or 0.0):
            self.noticed_s, self.noticed_on = other.noticed_s, other.noticed_on
        for mine, others in (
            (self.prevented, other.prevented),
            (self.shown, other.shown),
            (self.recovery, other.recovery),
        ):
            mine.extend(one for one in others if one not in mine)

    @property
    def noticed(self) -> str:
        """Return the cell that says how long the fault took to be noticed, or why it need not be."""
        if self.noticed_s is None:
            return self.prevented[0] if self.prevented else ""
        digits = 1 if self.noticed_on == VIRTUAL else 2
        return f"{self.noticed_s:.{digits}f} s, {self.noticed_on}"


def rows() -> list[Row]:
    """Return every row of the table, in order."""
    with GOLDEN.open(newline="") as file:
        return [
            Row(int(one["number"]), one["fault"], one["detection"], one["reaction"])
            for one in csv.DictReader(file)
        ]


def proofs() -> dict[int, list[str]]:
    """Return the tests of every row, as path and name, found in the tests' text."""
    found: defaultdict[int, list[str]] = defaultdict(list)
    for path in sorted(TESTS.rglob("test_*.py")):
        for name, number in _marked(ast.parse(path.read_text())):
            found[number].append(f"{path.relative_to(TESTS.parent)}::{name}")
    return dict(found)


def page(results: Mapping[int, Result]) -> str:
    """Return the page of all rows."""
    tests = proofs()
    return HEAD + "".join(_line(row, results.get(row.number, Result()), tests) for row in rows())


def run(*paths: str) -> dict[int, Result]:
    """Run the tests that prove rows and return what they recorded; end with a sentence if one fails."""
    collected = _Collector()
    code = pytest.main(["-m", "fault", "-q", "-p", "no:randomly", *paths], plugins=[collected])
    if code != pytest.ExitCode.OK:
        sys.exit("A test that proves a row of the fault table failed; the page was not written.")
    return collected.results


class _Collector:
    """Notes which rows a test proves, and what it recorded."""

    def __init__(self) -> None:
        self.results: defaultdict[int, Result] = defaultdict(Result)
        self._rows: dict[str, list[int]] = {}

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        for item in session.items:
            self._rows[item.nodeid] = [mark.args[0] for mark in item.iter_markers("fault")]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when != "call":
            return
        said = dict(report.user_properties)
        for number in self._rows.get(report.nodeid, []):
            self.results[number].take(_result(said))


def _result(said: Mapping[str, object]) -> Result:
    """Return what one test handed over by `FaultResult`."""
    words = {name: [str(said[name])] if name in said else [] for name in ("prevented", "shown", "recovery")}
    noticed_s = float(str(said["noticed_s"])) if "noticed_s" in said else None
    return Result(noticed_s, str(said.get("noticed_on", "")), **words)


def _marked(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield every test that is marked with a row, and the row."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        for mark in node.decorator_list:
            if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.fault":
                yield node.name, ast.literal_eval(mark.args[0])


def _line(row: Row, result: Result, tests: Mapping[int, list[str]]) -> str:
    shown, recovery = "<br>".join(result.shown), "<br>".join(result.recovery)
    named = "<br>".join(f"`{test.removeprefix('tests/')}`" for test in tests.get(row.number, []))
    cells = (str(row.number), row.fault, row.detection, result.noticed, row.reaction, shown, recovery, named)
    return "| " + " | ".join(cell.replace("|", "/").replace("\n", " ") for cell in cells) + " |\n"


def run_part(part: int, parts: int, paths: Sequence[str]) -> dict[int, Result] | None:
    """Run every so-manieth file and keep what it said; return all results once every part has passed."""
    PARTS.mkdir(parents=True, exist_ok=True)
    own = PARTS / f"{part}-of-{parts}.json"
    own.unlink(missing_ok=True)
    found = run(*paths[part - 1 :: parts])
    own.write_text(json.dumps({number: asdict(result) for number, result in found.items()}))
    files = [PARTS / f"{one}-of-{parts}.json" for one in range(1, parts + 1)]
    if not all(path.exists() for path in files):
        return None
    merged: defaultdict[int, Result] = defaultdict(Result)
    for path in files:
        for number, said in json.loads(path.read_text()).items():
            merged[int(number)].take(Result(**said))
        path.unlink()
    return merged


def main() -> None:
    """Write the page."""
    paths = sorted({test.split("::")[0] for tests in proofs().values() for test in tests})
    in_parts = len(sys.argv) == 3
    results = run_part(int(sys.argv[1]), int(sys.argv[2]), paths) if in_parts else run(*paths)
    if results is not None:
        PAGE.write_text(page(results))


if __name__ == "__main__":
    main()
