"""Every slot of the controller's state is written by one module, and there are ever fewer of them."""

import ast
from collections.abc import Iterator
from pathlib import Path

TRACKER = Path(__file__).parents[2] / "app" / "tracker"
STATE = "state/controller_state.py"
"""Lower it with the slots; never raise it: what is new belongs in one of the parts."""
OWNERS = {
    "activity": "state/transitions.py",
    "connection": "supervision/protect.py",
    "clear_until": "access/authority.py",
    "countdowns": "state/announce.py",
    "guarding": "supervision/weather_protection.py",
    "guards": "supervision/machine_guard.py",
    "made_up": "supervision/weather_protection.py",
    "recovery": "recovery.py",
    "setpoints": "state/setpoints.py",
    "supply_since": "supervision/machine_guard.py",
    "told_before": "supervision/machine_guard.py",
    "waiting": "state/waiting.py",
    "watches": "supervision/protect.py",
    "zeroed": "state/home_trust.py",
}
"""Who writes a slot; the others are the controller's own: what it is told at a tick, and what came out."""


def test_a_slot_is_written_by_its_owner_alone() -> None:
    foreign = [
        f"{path}: {slot}"
        for path, slot in _written()
        if path not in (OWNERS.get(slot, "controller.py"), STATE)
    ]
    assert not foreign


def test_every_owner_writes_its_slot() -> None:
    assert set(OWNERS.items()) <= {(slot, path) for path, slot in _written()}


def _written() -> Iterator[tuple[str, str]]:
    """Yield every module of the tracker with a slot that it assigns."""
    for path in sorted(TRACKER.rglob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            for target in _targets(node):
                if isinstance(target, ast.Attribute) and _is_state(target.value, path):
                    yield str(path.relative_to(TRACKER)), target.attr


def _targets(node: ast.AST) -> Iterator[ast.expr]:
    match node:
        case ast.Assign():
            for target in node.targets:
                yield from target.elts if isinstance(target, ast.Tuple) else (target,)
        case ast.AugAssign() | ast.AnnAssign():
            yield node.target
        case _:
            pass


def _is_state(value: ast.expr, path: Path) -> bool:
    named = ast.unparse(value)
    return named in ("state", "self._state") or (named == "self" and str(path.relative_to(TRACKER)) == STATE)
