"""No test of the gate reads the real clock, sleeps, or has a bound of its own.

What judges time stands in `tests/soak`. A wait takes `PATIENCE_S` of `tests/patience.py`, which only ends a
hang; time is a virtual clock, the patient loop, or the page's clock. An exception that has none fails too.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

TESTS = Path(__file__).parents[1] / "tests"
JUDGE_TIME = ("soak", "looks")
"""Folders that the gate does not run."""
CLOCKS = {"monotonic", "perf_counter", "monotonic_ns", "perf_counter_ns"}
SLEEPS = {"time.sleep", "asyncio.sleep"}
BOUNDED = {
    "wait_for": 1,
    "timeout": 0,
    "wait": 0,
    "join": 0,
    "settimeout": 0,
    "set_default_timeout": 0,
}
"""Which argument of a call is its bound."""
ASYNCIO = {"sleep", "wait_for", "timeout", "wait", "loop.time"}
"""What is harmless on the patient loop, where only waiting for nothing takes time."""

PATIENT = {
    "drives": "the patient loop (tests/drives/conftest.py)",
    "link": "the patient loop (tests/link/conftest.py)",
    "gateway/test_sunspec.py": "the patient loop (tests/gateway/conftest.py)",
    "gateway/test_mqtt_lanes.py": "the patient loop (tests/gateway/conftest.py)",
    "test_patient_loop.py": "tests the patient loop",
    "patient_loop.py": "is the patient loop",
    "site/test_waiting.py": "the patient loop (tests/site/conftest.py)",
}
EXCEPTIONS = {
    "drives/test_modbus_server.py": "pymodbus is silent for so long where no reply is wanted",
    "e2e/chromium.py": "tells the soak when it clicked",
    "e2e/product.py": "tells the soak when it sent a signal",
    "e2e/proxy.py": "tells the soak when it cut the cable",
    "e2e/socket_page.py": "its heartbeats carry the time, as those of a page do",
    "machine/lives.py": "tells the soak when it killed",
    "machine/service.py": "tells the soak after how long the axes rest",
    "machine/stories.py": "kills at an instant by chance, for the soak",
    "peers/modbus_tk_server.py": "a process of its own that serves until it is killed",
    "patience.py": "the one bound of all waits, and the pause between two looks",
}

SENTENCE = (
    "Use a virtual clock, the patient loop, or the page's clock; wait for an event with PATIENCE_S "
    "(tests/patience.py); what must be measured belongs to tests/soak."
)


def offences(path: Path) -> list[tuple[int, str]]:
    """Return where a file goes by the real clock, and how."""
    name = path.relative_to(TESTS).as_posix()
    patient = name in PATIENT or name.partition("/")[0] in PATIENT
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        for kind, told in _seen(node):
            if not (patient and kind in ASYNCIO):
                found.append((getattr(node, "lineno", 0), told))
    return sorted(set(found))


def _seen(node: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield how a piece of code goes by the real clock."""
    if isinstance(node, ast.ImportFrom) and node.module == "time":
        yield from ((one.name, f"from time import {one.name}") for one in node.names if one.name in CLOCKS)
    elif isinstance(node, ast.Attribute) and node.attr in CLOCKS:
        yield node.attr, ast.unparse(node)
    elif isinstance(node, ast.Call):
        yield from _called(node)


def _called(call: ast.Call) -> Iterator[tuple[str, str]]:
    told, function = ast.unparse(call), ast.unparse(call.func)
    name = function.rpartition(".")[2]
    if (function in SLEEPS and not _is_zero(call)) or name == "wait_for_timeout":
        yield function.removeprefix("asyncio."), told
    elif function.endswith(("loop.time", "get_running_loop().time")):
        yield "loop.time", told
    for keyword in call.keywords:
        bound = keyword.arg == "timeout" or (keyword.arg == "within_s" and name == "eventually")
        if bound and _is_number(keyword.value):
            yield (name if name in ASYNCIO else "bound"), told
    place = BOUNDED.get(name)
    if place is not None and len(call.args) > place and _is_number(call.args[place]):
        yield name, told


def _is_zero(call: ast.Call) -> bool:
    return bool(call.args) and isinstance(call.args[0], ast.Constant) and call.args[0].value == 0


def _is_number(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and isinstance(value.value, int | float) and value.value > 0


def faults() -> Iterator[str]:
    """Yield every offence, and every exception that has none."""
    wrong = False
    for path in sorted(TESTS.rglob("*.py")):
        name = path.relative_to(TESTS).as_posix()
        if name.partition("/")[0] in JUDGE_TIME:
            continue
        found, excused = offences(path), name in EXCEPTIONS
        for line, told in () if excused else found:
            wrong = True
            yield f"tests/{name}:{line}: {told.splitlines()[0][:90]}"
        if excused and not found:
            yield f"tests/{name} is clean: take it off the list in checks/clocks.py."
    for name in EXCEPTIONS:
        if not (TESTS / name).exists():
            yield f"tests/{name} is gone: take it off the list in checks/clocks.py."
    if wrong:
        yield SENTENCE
