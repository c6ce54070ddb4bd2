"""Changes the program place by place, in a copy, and counts what its tests notice.

`python -m tools.mutants` does every area, `python -m tools.mutants access drives` two of them. mutmut makes
all changes in one copy, `mutants/`; which of them is in force a process says for itself. Each is tried in a
fork of a process that has loaded the tests of its area (`tools/mutant_runs.py`): mutmut's own way takes ten
times as long, most of it for reports of failures that nobody reads.
"""

import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import mutmut.__main__ as mutmut
from mutmut.mutation.diff_apply import get_diff_for_mutant
from mutmut.mutation.trampoline import set_mutant_under_test

COPY = Path("mutants")
RESULTS = Path("build/mutants")
PROMISED = 0.95
GENERATING = "mutant_generation"


@dataclass(frozen=True, slots=True)
class Area:
    """How the names of what is changed begin, and the files of its tests."""

    changed: tuple[str, ...]
    tests: tuple[str, ...]


AREAS = {
    "guards": Area(
        (
            "app.tracker.motion.following_error.", "app.tracker.motion.guards.",
            "app.tracker.supervision.protect.", "app.tracker.protections.",
        ),
        (
            "tests/tracker/protections", "tests/tracker/test_controller_doubt.py",
            "tests/tracker/test_controller_protect.py", "tests/tracker/test_controller_restart.py",
            "tests/tracker/test_follow.py", "tests/tracker/test_guards.py", "tests/tracker/test_protect.py",
        ),
    ),
    "access": Area(("app.access.",), ("tests/access",)),
    "limits": Area(
        (
            "app.base.budget.", "app.gateway.", "app.link.lanes.", "app.base.turnstile.",
            "app.web.http.limits.", "app.web.live.hold_to_run.",
        ),
        (
            "tests/test_budget.py", "tests/test_turnstile.py", "tests/link/test_lanes.py",
            "tests/gateway/test_mqtt_lanes.py", "tests/gateway/test_quiet_door.py",
            "tests/gateway/test_sunspec.py", "tests/web/test_leases.py", "tests/web/test_presses.py",
            "tests/web/test_stream_limit.py",
        ),
    ),
    "panel": Area(
        ("app.web.http.gate.", "app.web.live.live_protocol.", "app.web.http.server."),
        (
            "tests/web/test_connections.py", "tests/web/test_gate_alone.py", "tests/web/test_gate_rules.py",
            "tests/web/test_http_alone.py", "tests/web/test_socket_alone.py",
        ),
    ),
    "drives": Area(
        ("app.drives.", "app.modbus.", "app.simulation."),
        (
            "tests/drives/test_conformance.py", "tests/drives/test_kept_positions.py",
            "tests/drives/test_lost_commands.py", "tests/drives/test_modbus_clients.py",
            "tests/drives/test_plausibility.py", "tests/drives/test_plc.py", "tests/drives/test_plc_signs.py",
            "tests/drives/test_requests.py", "tests/drives/test_unit.py",
            "tests/drives/test_vendor_frames.py", "tests/drives/test_write_frame.py",
        ),
    ),
    "control": Area(
        ("app.tracker.access.authority.", "app.tracker.commands.control.", "app.site."),
        (
            "tests/tracker/test_authority.py", "tests/tracker/test_faults.py", "tests/site/test_authority.py",
            "tests/site/test_control.py", "tests/site/test_control_told.py",
        ),
    ),
}  # fmt: skip


def main(names: Iterable[str]) -> int:
    """Try every change of these areas; 1 if less than was promised is noticed in one of them."""
    make_copy()
    return max([_area(name) for name in names or AREAS])


def make_copy() -> None:
    """Copy the project with every change in it, as mutmut is told to in pyproject.toml."""
    set_mutant_under_test(GENERATING)
    shutil.rmtree(COPY, ignore_errors=True)
    COPY.mkdir()
    with redirect_stdout(StringIO()):
        mutmut.copy_src_dir()
        mutmut.copy_also_copy_files()
        mutmut.setup_source_paths()
        mutmut.store_lines_covered_by_tests()
        mutmut.create_mutants(os.cpu_count() or 1)


def changes(area: Area) -> list[str]:
    """Return the names of all changes of an area; to be called in the copy."""
    found = (json.loads(path.read_text())["exit_code_by_key"] for path in sorted(Path("app").rglob("*.meta")))
    return [name for names in found for name in names if name.startswith(area.changed)]


def _area(name: str) -> int:
    RESULTS.mkdir(parents=True, exist_ok=True)
    result = (RESULTS / f"{name}.json").resolve()
    environment = os.environ | {"MUTANT_UNDER_TEST": ""}
    running = (sys.executable, "-m", "tools.mutant_runs", name, str(result))
    log = (RESULTS / f"{name}.log").resolve()
    with log.open("wb") as written:
        done = subprocess.run(running, cwd=COPY, env=environment, stdout=written, stderr=written)
    if done.returncode:
        print(f"{name}: the tests fail without any change, see {log}")
        return 1
    ends: dict[str, str] = json.loads(result.read_text())
    count = Counter(ends.values())
    noticed = count["noticed"] + count["endless"]
    share = noticed / len(ends)
    left = RESULTS / f"{name}.left"
    left.write_text(
        "\n".join(_told(change, end) for change, end in ends.items() if end in ("left", "untried"))
    )
    print(
        f"{name}: {noticed} of {len(ends)} changes noticed ({share:.1%}), {count['endless']} because they "
        f"never end; {count['left']} left, {count['untried']} that no test comes by: {left}"
    )
    return int(share < PROMISED)


def _told(change: str, end: str) -> str:
    return f"{end}: {change}\n{get_diff_for_mutant(change)}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
