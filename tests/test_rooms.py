"""A folder is a room: few modules, one subject, and none imports a folder that imports it."""

import ast
from functools import cache
from pathlib import Path

from app.base.own import PROGRAM

MOST = 24


@cache
def _modules() -> dict[str, Path]:
    return {
        ".".join(path.relative_to(PROGRAM.parent).with_suffix("").parts): path
        for path in PROGRAM.rglob("*.py")
        if path.name != "__init__.py"
    }


def _folder(module: str) -> str:
    return module.rpartition(".")[0]


def _imported(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{name.name}" for name in node.names}
    return found & _modules().keys()


def test_a_folder_has_few_modules() -> None:
    folders = [_folder(module) for module in _modules()]
    too_many = {name: count for name in set(folders) if (count := folders.count(name)) > MOST}
    assert too_many == {}


def test_no_folder_imports_one_that_imports_it() -> None:
    reached = {_folder(module): {_folder(module)} for module in _modules()}
    imports = {
        (_folder(module), _folder(other)) for module, path in _modules().items() for other in _imported(path)
    }
    while further := {(one, two) for one, two in imports if not reached[two] <= reached[one]}:
        for one, two in further:
            reached[one] |= reached[two]
    circles = {(one, two) for one in reached for two in reached[one] - {one} if one in reached[two]}
    assert circles == set()
