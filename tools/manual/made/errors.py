"""Every status of an error and every code of a reason, from where they are made."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from app.base.own import PROGRAM
from app.web.http.problems import ProblemCode, phrase
from tools.manual.made.markdown import code, page, table, text

INTRODUCTION = """Errors of the API are `application/problem+json` (RFC 9457). `code` is the kind of problem,
with one status each, and `type` the address of its section on this page. `title` is the status in words, and
`detail` a sentence for the user who reads it. `errors` has every wrong value: `pointer` is a JSON Pointer
(RFC 6901) into the body, `parameter` the name of a query parameter, a header, or a part of the path.

A rejected command has `reasons`: every unmet condition with `code`, `message`, and `hint`. The same reasons
are on the pages, in the journal, and in answers over MQTT. Programs go by codes; sentences may change and are
translated."""
LEAST_LETTERS = 3


@dataclass
class Said:
    """What is said under one code."""

    messages: set[str] = field(default_factory=set)
    hints: set[str] = field(default_factory=set)


def errors_page() -> str:
    """Return the page."""
    reasons = [
        (code(name), _several(said.messages), _several(said.hints))
        for name, said in sorted(_reasons().items())
    ]
    return page(
        "Errors",
        INTRODUCTION,
        "## Problems\n\n" + "\n\n".join(_kind(code) for code in ProblemCode),
        "## Codes of reasons\n\nAn ellipsis stands for a value.\n\n"
        + table(("code", "message", "hint"), reasons),
    )


def _several(sentences: set[str]) -> str:
    return "<br>".join(text(one) for one in sorted(sentences))


def _kind(kind: ProblemCode) -> str:
    """Return a section that `type` leads to."""
    return f"### {code(kind.value)}\n\n{kind.status} {phrase(kind.status)}. {text(kind.when)}"


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
