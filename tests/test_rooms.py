"""A folder is a room: few modules, one subject, and none imports a folder that imports it."""

import ast
from functools import cache
from pathlib import Path

from app.base.own import PROGRAM, own_folder

MOST = 24
LONGEST_LINE = 140
MOST_LINES = 400
LONGEST_BODY = 50


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


def test_a_line_of_a_template_is_read_at_a_glance() -> None:
    lines = [
        (path.name, number, len(line))
        for path in sorted(own_folder("templates").rglob("*.html"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
    ]
    assert len(lines) > 2000
    assert [found for found in lines if found[2] > LONGEST_LINE] == []


def test_files_and_functions_are_read_at_a_sitting() -> None:
    long_files, long_functions = {}, {}
    for module, path in _modules().items():
        text = path.read_text(encoding="utf-8")
        if (count := len(text.splitlines())) > MOST_LINES:
            long_files[module] = count
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.end_lineno is not None:
                length = node.end_lineno - node.lineno
                if length > LONGEST_BODY:
                    long_functions[module, node.name] = length
    assert (long_files, long_functions) == ({}, {})
