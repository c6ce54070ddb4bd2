"""Every status of an error and every code of a reason, from where they are made."""

import ast
import inspect
from collections.abc import Iterator
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path

from app.own import PROGRAM
from app.web import errors
from tests.manual.made.markdown import code, page, table, text

INTRODUCTION = """Errors of the API are `application/problem+json` (RFC 9457): `status`, `title`, and
`detail`, a sentence for the person who reads it. A refused order has `reasons`: every unmet condition
with `code`, `message`, and `hint`. The same reasons are on the pages, in the journal, and in answers
over MQTT. Programs go by status and code; sentences may change and are translated."""
LEAST_LETTERS = 3


@dataclass
class Said:
    """What is said under one code."""

    messages: set[str] = field(default_factory=set)
    hints: set[str] = field(default_factory=set)


def errors_page() -> str:
    """Return the page."""
    statuses = [
        (status, HTTPStatus(status).phrase, "; ".join(sorted(when)))
        for status, when in sorted(_statuses().items())
    ]
    reasons = [
        (code(name), _several(said.messages), _several(said.hints))
        for name, said in sorted(_reasons().items())
    ]
    return page(
        "Errors",
        INTRODUCTION,
        "## Statuses\n\n" + table(("status", "title", "when"), statuses),
        "## Codes of reasons\n\nAn ellipsis stands for a value.\n\n"
        + table(("code", "message", "hint"), reasons),
    )


def _several(sentences: set[str]) -> str:
    return "<br>".join(text(one) for one in sorted(sentences))


def _statuses() -> dict[int, set[str]]:
    """Return what leads to each status: the first sentence of every exception that becomes it."""
    tree = ast.parse(inspect.getsource(errors))
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    (known,) = (
        node.value
        for node in tree.body
        if isinstance(node, ast.AnnAssign)
        and isinstance(node.target, ast.Name)
        and node.target.id == "PROBLEMS"
    )
    assert isinstance(known, ast.Dict)
    found: dict[int, set[str]] = {}
    for kind, builder in zip(errors.PROBLEMS, known.values, strict=True):
        if kind.__module__.partition(".")[0] != "app":
            continue
        node = functions[builder.id] if isinstance(builder, ast.Name) else builder
        for status in _numbers(node):
            found.setdefault(status, set()).add(_first_sentence(kind))
    return found


def _numbers(node: ast.AST) -> Iterator[int]:
    for call in ast.walk(node):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "Problem":
            for number in ast.walk(call.args[0]):
                if isinstance(number, ast.Constant) and isinstance(number.value, int):
                    yield number.value


def _first_sentence(kind: type[Exception]) -> str:
    return " ".join((inspect.getdoc(kind) or "").split()).partition(";")[0].partition(". ")[0].rstrip(".")


def _reasons() -> dict[str, Said]:
    found: dict[str, Said] = {}
    for path in sorted(PROGRAM.rglob("*.py")):
        for name, message, hint in _in_module(path):
            said = found.setdefault(name, Said())
            said.messages |= {message} if message else set()
            said.hints |= {hint} if hint else set()
    return found


def _in_module(path: Path) -> Iterator[tuple[str, str, str]]:
    for call in ast.walk(ast.parse(path.read_text())):
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "Reason"):
            continue
        given = dict(zip(("code", "message", "hint"), call.args, strict=False))
        given |= {one.arg: one.value for one in call.keywords if one.arg}
        if isinstance(given.get("code"), ast.Constant):
            name, message, hint = (_sentence(given.get(part)) for part in ("code", "message", "hint"))
            yield name, message, hint


def _sentence(node: ast.expr | None) -> str:
    """Return what a text says, an ellipsis for what is put into it, nothing for a text made elsewhere."""
    match node:
        case ast.Constant(value=str(said)):
            return said
        case ast.JoinedStr(values=parts):
            said = "".join(_sentence(part) or "…" for part in parts)
            return said if sum(letter.isalpha() for letter in said) > LEAST_LETTERS else ""
        case _:
            return ""
