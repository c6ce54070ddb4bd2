"""What Python and the scripts of a page both know is said in Python and sent: no script writes it again."""

import ast
import re
from pathlib import Path

import orjson

from app.web.shell.page_facts import page_facts

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted((ROOT / "static" / "js").rglob("*.js"))
NUMBER = re.compile(r"^([A-Z][A-Z0-9_]*)(?:: \w+)? = (-?[\d_.]+)$", re.MULTILINE)
CONSTANT = re.compile(r"^(?:export )?const ([A-Z][A-Z0-9_]*) = (-?[\d_.]+);", re.MULTILINE)


def script(path: Path) -> str:
    return str(path.relative_to(ROOT / "static" / "js"))


def constants_of_python() -> dict[str, set[float]]:
    """Return every number that a module of the program has a name for."""
    found: dict[str, set[float]] = {}
    for path in (ROOT / "app").rglob("*.py"):
        for name, number in NUMBER.findall(path.read_text()):
            found.setdefault(name, set()).add(float(ast.literal_eval(number)))
    return found


def test_no_limit_of_the_program_is_written_in_a_script() -> None:
    known = constants_of_python()
    twins = {
        (script(path), name)
        for path in SCRIPTS
        for name, value in CONSTANT.findall(path.read_text())
        if float(value.replace("_", "")) in known.get(name, ())
    }
    assert not twins


def test_every_fact_is_used_by_a_script() -> None:
    sources = "".join(path.read_text() for path in SCRIPTS)
    for name in orjson.loads(str(page_facts("en"))):
        assert re.search(rf"\bfacts\.{name}\b", sources), name
