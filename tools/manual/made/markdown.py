"""Markdown for pages that a program writes."""

from collections.abc import Iterable, Sequence

MADE = "*Made of the code by `make reference`; change it there.*"


def page(title: str, introduction: str, *parts: str) -> str:
    """Return a whole page."""
    return "\n\n".join((f"# {title}", introduction, *parts, MADE)) + "\n"


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cell(one) for one in line)} |" for line in lines)


def cell(what: object) -> str:
    """Return what a cell says: one line, without what would end it."""
    return " ".join(str(what).split()).replace("|", "\\|")


def code(what: object) -> str:
    """Return something to type or to read as it stands, nothing for nothing."""
    return f"`{what}`" if str(what) else ""


def text(what: str) -> str:
    """Return a sentence of the program, whose asterisks and angles mean themselves."""
    return what.replace("<", "\\<").replace("*", "\\*")
