"""Sources can be read: short files, functions and lines of templates, and no circle between folders."""

import ast
from collections.abc import Iterator
from functools import cache

from app.base.own import PROGRAM, own_folder

LONGEST_LINE = 140
MOST_LINES = 400
LONGEST_BODY = 50


def faults() -> Iterator[str]:
    """Yield what is too long, and what imports what imports it."""
    for module, tree in trees().items():
        yield from _too_long(module, tree)
    for path in sorted(own_folder("templates").rglob("*.html")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if len(line) > LONGEST_LINE:
                yield f"templates/{path.name}:{number} has more than {LONGEST_LINE} letters: divide the line."
    for one, other in sorted(circles()):
        yield f"{one} and {other} import each other: move what both need into a folder of its own."


@cache
def trees() -> dict[str, ast.Module]:
    """Return the syntax trees of the program's modules."""
    return {
        ".".join(path.relative_to(PROGRAM.parent).with_suffix("").parts): ast.parse(path.read_text())
        for path in sorted(PROGRAM.rglob("*.py"))
        if path.name != "__init__.py"
    }


def _too_long(module: str, tree: ast.Module) -> Iterator[str]:
    path = PROGRAM.parent / f"{module.replace('.', '/')}.py"
    if len(path.read_text().splitlines()) > MOST_LINES:
        yield f"{module} has more than {MOST_LINES} lines: divide it."
    functions = (one for one in ast.walk(tree) if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef))
    for node in functions:
        if (node.end_lineno or 0) - node.lineno > LONGEST_BODY:
            yield f"{module}:{node.lineno} {node.name} has more than {LONGEST_BODY} lines: divide it."


def circles() -> set[tuple[str, str]]:
    """Return the folders that import, over whatever way, what imports them."""
    imports = {
        (_folder(module), _folder(other)) for module, tree in trees().items() for other in _imported(tree)
    }
    reached = {_folder(module): {_folder(module)} for module in trees()}
    while further := {(one, two) for one, two in imports if not reached[two] <= reached[one]}:
        for one, two in further:
            reached[one] |= reached[two]
    return {(one, two) for one in reached for two in reached[one] if one < two and one in reached[two]}


def _folder(module: str) -> str:
    return module.rpartition(".")[0]


def _imported(tree: ast.Module) -> set[str]:
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{name.name}" for name in node.names}
    return found & trees().keys()
