"""What stands in the gap of a sentence is a name, a number or a message: English words there stay English."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

APP = Path(__file__).parents[3] / "app"
MODULES = sorted(
    path for path in APP.rglob("*.py") if "cli" not in path.parts and "servers" not in path.parts
)
WORD = re.compile(r"[A-Za-z]{2}")


def is_english(value: ast.expr) -> bool:
    """Return whether words are written where a value is made, not marked as a message."""
    match value:
        case ast.Constant(value=str(text)):
            return bool(WORD.search(text))
        case ast.JoinedStr(values=parts):
            return any(isinstance(part, ast.Constant) and is_english(part) for part in parts)
        case ast.IfExp(body=one, orelse=other):
            return is_english(one) or is_english(other)
        case ast.Call(func=ast.Attribute(attr="join", value=between)):
            return is_english(between)
        case _:
            return False


def english_values(tree: ast.AST) -> Iterator[int]:
    """Yield the lines of sentences with English words among their values, written there or just before."""
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        inside = list(ast.walk(function))
        named = {
            target.id
            for one in inside
            if isinstance(one, ast.Assign) and is_english(one.value)
            for target in one.targets
            if isinstance(target, ast.Name)
        }
        for call in inside:
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "say":
                values = [one.value for one in call.keywords]
                if any(is_english(one) or (isinstance(one, ast.Name) and one.id in named) for one in values):
                    yield call.lineno


def test_no_sentence_has_english_words_among_its_values() -> None:
    found = {
        f"{path.relative_to(APP)}:{line}"
        for path in MODULES
        for line in english_values(ast.parse(path.read_text()))
    }
    assert found == set()


@pytest.mark.parametrize(
    "source",
    [
        'say("{a} is open.", a="the door")',
        'say("{a} is open.{more}", a=name, more=f" Reason: {why}" if why else "")',
        'say("Sent by {parts}.", parts=" and by ".join(parts))',
        'more = "nobody" if who is None else who\n    say("{more} is here.", more=more)',
    ],
)
def test_english_words_among_values_are_found(source: str) -> None:
    assert list(english_values(ast.parse(f"def f():\n    {source}")))
