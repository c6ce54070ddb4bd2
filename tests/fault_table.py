"""The table of faults: every row with its tests, what they measured, and the page made from their results.

python -m tests.fault_table             run every test that proves a row, and write docs/faults.md
python -m tests.fault_table PART PARTS  run one of so many parts; the page is written once all have passed
python -m tests.fault_table --measured  run those that measure alone, and write the page
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

TESTS = Path(__file__).parent
GOLDEN = TESTS / "golden" / "fault_table.csv"
PAGE = TESTS.parent / "docs" / "faults.md"
PARTS = TESTS.parent / "build" / "faults"

HEAD = """# What can go wrong

Every row of the fault table with what notices it, what follows, what the operator reads and how it ends.
Made by `python -m tests.fault_table` from the results of the tests that each row names; change those, not
this page. Fault, detection and reaction are the design's; what a test measured stands beside them.

*Noticed after* is the time on the virtual clock, a tick every 0.1 s, from the fault to the first word of it,
the longest of several tests (on a site's clock looks at alarms come twice a second, and some alarms wait 3 s
before they are raised); "not measured" where the subject is a real clock, socket, process or page, or
nothing is noticed. A sentence without "designed:" is the one that was shown. A latched fault is left by a
person unless an engineer set another policy for its class; see
[decision 0026](decisions/0026-recovery-is-a-policy.md).

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
    shown: str


@dataclass(slots=True)
class Result:
    """What the tests of one row said."""

    detected_s: float | None = None
    shown: list[str] = field(default_factory=list)
    policy: str = ""

    def take(self, other: "Result") -> None:
        """Take in what more tests said: the longest time, every sentence."""
        if other.detected_s is not None:
            self.detected_s = max(self.detected_s or 0.0, other.detected_s)
        self.shown.extend(one for one in other.shown if one not in self.shown)
        self.policy = other.policy or self.policy


def rows() -> list[Row]:
    """Return every row of the table, in order."""
    with GOLDEN.open(newline="") as file:
        return [
            Row(int(one["number"]), one["fault"], one["detection"], one["reaction"], one["shown"])
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
            detected_s = float(str(said["detected_s"])) if "detected_s" in said else None
            shown = [str(said["shown"])] if "shown" in said else []
            self.results[number].take(Result(detected_s, shown, str(said.get("policy", ""))))


def _marked(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield every test that is marked with a row, and the row."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        for mark in node.decorator_list:
            if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.fault":
                yield node.name, ast.literal_eval(mark.args[0])


def _line(row: Row, result: Result, tests: Mapping[int, list[str]]) -> str:
    noticed = "not measured" if result.detected_s is None else f"{result.detected_s:.1f} s"
    shown = result.shown[0] if result.shown else f"designed: {row.shown}"
    named = (
        "<br>".join(f"`{test.removeprefix('tests/')}`" for test in tests.get(row.number, [])) or "none yet"
    )
    cells = (str(row.number), row.fault, row.detection, noticed, row.reaction, shown, result.policy, named)
    return "| " + " | ".join(cell.replace("|", "/") for cell in cells) + " |\n"


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
    if "--measured" in sys.argv:
        measuring = [path for path in paths if "record_property" in (TESTS.parent / path).read_text()]
        results: Mapping[int, Result] | None = run(*measuring)
    elif len(sys.argv) == 3:
        results = run_part(int(sys.argv[1]), int(sys.argv[2]), paths)
    else:
        results = run(*paths)
    if results is not None:
        PAGE.write_text(page(results))


if __name__ == "__main__":
    main()
