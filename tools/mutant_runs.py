"""Tries every change of an area, in the copy that `tools/mutants.py` made: each in a fork of this process."""

import json
import os
import resource
import signal
import struct
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from mmap import mmap
from pathlib import Path
from typing import Any, NamedTuple

import mutmut.mutation.trampoline as trampoline
import pytest

from tools.mutants import AREAS, changes

AT_ONCE = os.cpu_count() or 1
CPU_FACTOR, CPU_MORE_S = 5, 8
IDLE_FOR_S, IDLE_CPU_S = 12.0, 0.1
"""A change is endless when its tests compute so much longer than without it, or wait and compute nothing.

How long they last says little: other programs may keep the processors busy.
"""

ENDS = {0: "left", 1: "noticed"}
COUNTER = struct.Struct("<I")


class Timed(NamedTuple):
    """A test that comes by a function, and the processor's time that it takes."""

    item: pytest.Item
    cpu_s: float


@dataclass
class Fork:
    """The fork that tries a change; what it had computed when, last that it was seen to compute."""

    change: str
    cpu_s: float
    at_s: float

    def waits(self, process_id: int) -> bool:
        """Return whether it has slept for a while; what only waits for a processor or a disk has not."""
        fields = Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()
        cpu_s = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        now_s = time.monotonic()
        sleeps = fields[0] == "S"
        if not sleeps or cpu_s - self.cpu_s > IDLE_CPU_S:
            self.cpu_s, self.at_s = cpu_s, now_s
        return now_s - self.at_s > IDLE_FOR_S


class Trying:
    """In the place of pytest's loop: each test once as it is, then for each change those that come by it."""

    def __init__(self, area: str, result: Path) -> None:
        self._area, self._result = AREAS[area], result
        self._failed = False
        self._on_failure: Callable[[pytest.Item], None] | None = None
        self._by_function: dict[str, list[Timed]] = defaultdict(list)
        self._running: dict[int, Fork] = {}
        self._ends: dict[str, str] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> None:
        """Know of a failure before its report is made: that reads the copy's long files, for seconds."""
        if call.excinfo is not None and not isinstance(call.excinfo.value, pytest.skip.Exception):
            self._failed = True
            if self._on_failure is not None:
                self._on_failure(item)

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try everything; a test that fails without a change ends it."""
        self._look(session.items)
        self._order = {item: number for number, item in enumerate(session.items)}
        self._noticed = mmap(-1, COUNTER.size * len(session.items))
        for number, change in enumerate(changes(self._area)):
            self._try(change)
            if number % 100 == 0:
                print(number, "tried", file=sys.__stderr__, flush=True)
        while self._running:
            self._wait()
        self._result.write_text(json.dumps(self._ends, indent=0))
        return True

    def _look(self, items: list[pytest.Item]) -> None:
        came_by: set[str] = set()
        trampoline.record_trampoline_hit = lambda name, caller=None: came_by.add(name)
        os.environ["MUTANT_UNDER_TEST"] = "stats"
        for item in items:
            came_by.clear()
            cpu_s = time.process_time()
            self._run(item)
            if self._failed:
                raise pytest.UsageError(f"{item.nodeid} fails without any change.")
            timed = Timed(item, time.process_time() - cpu_s)
            for function in came_by:
                self._by_function[function].append(timed)
        os.environ["MUTANT_UNDER_TEST"] = ""

    def _run(self, item: pytest.Item) -> None:
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)

    def _try(self, change: str) -> None:
        """Run the tests that come by it in a fork, the quick ones and those that notice much first."""
        tests = sorted(
            self._by_function[change.rpartition("__mutmut_")[0]],
            key=lambda timed: timed.cpu_s / (1 + self._count(timed.item)),
        )
        if not tests:
            self._ends[change] = "untried"
            return
        while len(self._running) >= AT_ONCE:
            self._wait()
        process_id = os.fork()
        if not process_id:
            self._run_all(change, tests)
        self._running[process_id] = Fork(change, 0.0, time.monotonic())

    def _run_all(self, change: str, tests: list[Timed]) -> None:
        longest_s = time.process_time() + sum(timed.cpu_s for timed in tests) * CPU_FACTOR + CPU_MORE_S
        resource.setrlimit(resource.RLIMIT_CPU, (int(longest_s),) * 2)
        self._on_failure = self._notice
        trampoline.set_mutant_under_test(change)
        for timed in tests:
            self._run(timed.item)
        os._exit(0)

    def _notice(self, item: pytest.Item) -> None:
        COUNTER.pack_into(self._noticed, COUNTER.size * self._order[item], self._count(item) + 1)
        os._exit(1)

    def _count(self, item: pytest.Item) -> int:
        count: int = COUNTER.unpack_from(self._noticed, COUNTER.size * self._order[item])[0]
        return count

    def _wait(self) -> None:
        """Take the end of one fork if there is one; end those that wait for what never comes."""
        process_id, status = os.waitpid(-1, os.WNOHANG)
        if process_id:
            change = self._running.pop(process_id).change
            self._ends[change] = ENDS.get(os.waitstatus_to_exitcode(status), "endless")
            return
        for running, fork in self._running.items():
            if fork.waits(running):
                os.kill(running, signal.SIGKILL)
        time.sleep(0.01)


def main(area: str, result: str) -> int:
    """Return 0 if every change of the area was tried."""
    trying: Any = Trying(area, Path(result))
    options = ("-p", "no:cacheprovider", "-p", "no:xdist", "-k", "not postgresql", "--timeout", "0")
    return int(pytest.main([*options, *AREAS[area].tests], plugins=[trying]))


if __name__ == "__main__":
    sys.path.insert(0, os.getcwd())
    sys.exit(main(*sys.argv[1:]))
