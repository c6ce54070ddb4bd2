"""In which order tests run: the longest file first, so that no worker ends alone; or any order, by a seed.

`tests/durations.json` says how many seconds each file took when it was last written, with
`--write-durations`; files that it does not know come last. What share fixtures stay together in both.
"""

import json
import random
from collections import defaultdict
from pathlib import Path

import pytest

DURATIONS = Path(__file__).parent / "durations.json"
SHORTEST_S = 2.0
"""What is shorter need not be known."""


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("order of the tests")
    group.addoption("--random-order", metavar="SEED", help="shuffle files, and the tests of each")
    group.addoption("--write-durations", action="store_true", help=f"renew {DURATIONS.name} from this run")


def file_of(nodeid: str) -> str:
    return nodeid.partition("::")[0]


def in_order(nodeids: list[str], durations: dict[str, float], seed: str | None) -> list[int]:
    """Return the places of the tests in their new order; a file's tests stay together."""
    files: dict[str, list[int]] = defaultdict(list)
    for place, nodeid in enumerate(nodeids):
        files[file_of(nodeid)].append(place)
    names = sorted(files, key=lambda name: -durations.get(name, 0.0))
    if seed is not None:
        chance = random.Random(seed)
        chance.shuffle(names)
        for name in names:
            chance.shuffle(files[name])
    return [place for name in names for place in files[name]]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Order the tests before pytest groups those that share a parameter of a module."""
    durations = json.loads(DURATIONS.read_text()) if DURATIONS.exists() else {}
    seed = config.getoption("--random-order")
    items[:] = [items[place] for place in in_order([item.nodeid for item in items], durations, seed)]


def pytest_report_header(config: pytest.Config) -> list[str]:
    seed = config.getoption("--random-order")
    return [] if seed is None else [f"tests in random order: --random-order={seed}"]


@pytest.hookimpl
def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Write how long each file took, where that is asked for."""
    if not config.getoption("--write-durations"):
        return
    took: dict[str, float] = json.loads(DURATIONS.read_text()) if DURATIONS.exists() else {}
    ran: dict[str, float] = defaultdict(float)
    for reports in terminalreporter.stats.values():
        for report in reports:
            if isinstance(report, pytest.TestReport):
                ran[file_of(report.nodeid)] += report.duration
    took |= {name: round(seconds) for name, seconds in ran.items()}
    kept = {name: took[name] for name in sorted(took) if took[name] >= SHORTEST_S}
    DURATIONS.write_text(json.dumps(kept, indent=1) + "\n")
