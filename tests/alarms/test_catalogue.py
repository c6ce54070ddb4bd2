"""Every reason that says something is wrong is an alarm, and every alarm is in the operator's guide."""

import ast
from pathlib import Path

from app.alarms.catalogue import CATALOGUE, ENTRIES
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.settings.mechanics import FaultClass

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "operate" / "operators-guide.md").read_text()
FAULTS = (
    "motion/guards.py",
    "supervision/machine_guard.py",
    "supervision/protect.py",
    "activities/faulted.py",
)
WHERE = ROOT / "app" / "tracker"
EVENTS_ONLY = {"drive_back", "not_homed", "at_limit_switch"}
"""A drive that came back in order asks for nothing; a lost zero is told by `home_lost`, a switch that was run
into by `limit_switch`: that one is on says which way is free."""


def test_every_alarm_has_its_entry_in_the_operators_guide() -> None:
    for entry in ENTRIES:
        row = next(line for line in GUIDE.splitlines() if f'id="alarm-{entry.code}"' in line)
        for said in (entry.title, f"| {entry.priority} |", entry.consequence, entry.do):
            assert said in row
        assert entry.priority > 1 or not entry.suppressed_by
        assert set(entry.suppressed_by) <= CATALOGUE.keys() - {entry.code}
    assert len(CATALOGUE) == len(ENTRIES), "no code twice"


def test_every_fault_of_the_guards_is_an_alarm() -> None:
    found = {code for name in FAULTS for code in _codes(WHERE / name)}
    assert len(found) > 8
    assert found - {one.code for one in ENTRIES} - EVENTS_ONLY == set(), (
        "write an entry for each in app/alarms/catalogue.py and in the operator's guide, Alarms"
    )


def test_every_fault_with_a_class_of_recovery_is_an_alarm() -> None:
    assert CLASSES.keys() - {one.code for one in ENTRIES} == set()
    assert set(CLASSES.values()) == set(FaultClass)


def _codes(path: Path) -> set[str]:
    """Return the codes of the reasons that a module makes."""
    return {
        str(node.args[0].value)
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "Reason"
        and node.args
        and isinstance(node.args[0], ast.Constant)
    }
