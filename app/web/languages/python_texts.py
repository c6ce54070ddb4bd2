"""The sentences and labels that a Python module can say, read from its source."""

import ast
import re
from collections.abc import Iterable, Iterator
from itertools import islice, product

from app.web.languages.catalogue import LONGEST
from app.web.languages.known import in_words
from app.web.languages.patterns import GAP

MOST_VARIANTS = 16

_SILENT_CALLS = """
    debug info warning error exception critical compile match search fullmatch sub split findall execute text
    Field Query Path Header Form Body Column ForeignKey Index CheckConstraint Option Argument getattr setattr
    hasattr strftime strptime encode normalize startswith endswith removeprefix removesuffix import_module
    TypeVar literal_column mapped_column namedtuple ContextVar add_api_route open echo AssertionError
    TypeError KeyError NotImplementedError RuntimeError"""
_SILENT_KEYWORDS = """
    responses media_type tags encoding pattern response_description alias examples
    deprecated template prefix key id code kind picture guide href name_of drawing icon"""
_PLAIN_CALLS = "abs str round len sorted float int repr max min map getattr"
SILENT_CALLS, SILENT_KEYWORDS = frozenset(_SILENT_CALLS.split()), frozenset(_SILENT_KEYWORDS.split())
PLAIN_CALLS = frozenset(_PLAIN_CALLS.split())
SILENT_NAMES = re.compile(
    r"^_?(SQL|DDL|DESCRIPTION|STREAM|HEADERS|HTML|SVG|COLOUR|MEDIA|PATTERN|SCHEMA|TRIGGER)|_(SQL|DDL|HTML|PATTERN)$"
)
SILENT_ENUMS = re.compile(r"^(PointType|Framing|Verdict)$|Format$")
"""Words of these reach no page."""
SILENT_FIELDS = frozenset(("description", "summary"))
"""What an API documents under these names."""

WORD = re.compile(r"[^\W\d_]{2,}")
LABEL = re.compile(r"[A-Z][a-z]{2,}(-[a-z]+)*\.?|[A-Z]{2,5}s?|\d+ [A-Z][a-z]{2,}")
MACHINE = re.compile(
    r"^[\s<#./\[{&;]*<|://|^/|^\w+/[\w.+-]+|^#|^--|^(GET|POST|PUT|DELETE|WS) |[\x00-\x08]|%[YmdHMS]|charset="
    r"|</|\b(SELECT|INSERT|UPDATE|DELETE FROM|CREATE|PRAGMA|ALTER|DROP)\b|\bviewBox\b|^[MLHVZ][\d{]"
    r"|^[a-z0-9_.:;=\-/ ]*[_=;][a-z0-9_.:;=\-/ %]*$|^attachment;"
)


def python_texts(source: str) -> Iterator[tuple[int, str]]:
    """Return line and text of everything in a module that reads like words for people.

    The gaps of an f-string carry the name of what stands in them; where a gap chooses between two words,
    there are two sentences.
    """
    reader = _Reader()
    reader.visit(ast.parse(source))
    seen = set()
    for line, text in reader.found:
        if text not in seen and len(text) <= LONGEST:
            seen.add(text)
            yield line, text


class _Reader(ast.NodeVisitor):
    """Collects texts; what a program reads, such as keys, comparisons and log lines, is left out."""

    def __init__(self) -> None:
        self.found: list[tuple[int, str]] = []

    def visit_Expr(self, node: ast.Expr) -> None:
        """Leave out docstrings."""
        if not isinstance(node.value, ast.Constant):
            self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        """Leave out what is told to logs, patterns, databases and documentation."""
        if _called(node.func) in SILENT_CALLS:
            self._calls_within(node)
            return
        self.visit(node.func)
        for given in node.args:
            self.visit(given)
        for keyword in node.keywords:
            if keyword.arg not in SILENT_KEYWORDS:
                self.visit(keyword.value)

    def _calls_within(self, node: ast.Call) -> None:
        for given in (*node.args, *(keyword.value for keyword in node.keywords)):
            if isinstance(given, ast.Call):
                self.visit(given)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        """Read the words of an enumeration as people write them."""
        if any(_called(base) == "StrEnum" for base in node.bases):
            if SILENT_ENUMS.search(node.name):
                return
            for entry in node.body:
                if isinstance(entry, ast.Assign) and isinstance(entry.value, ast.Constant):
                    self._enum_word(entry.value)
            return
        for statement in node.body:
            self.visit(statement)

    def _enum_word(self, node: ast.Constant) -> None:
        text = in_words(node.value)
        if WORD.search(text):
            self.found.append((node.lineno, text))

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        """Leave out annotations, decorators and the defaults of parameters."""
        for statement in node.body:
            self.visit(statement)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        """Read it as any function."""
        self.visit_FunctionDef(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        """Leave out the annotation."""
        if node.value is not None:
            self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        """Leave out constants that their names tell to be for programs."""
        names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        if not any(SILENT_NAMES.search(name) for name in names):
            self.visit(node.value)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        """Leave out keys."""
        self.visit(node.value)

    def visit_Compare(self, node: ast.Compare) -> None:
        """Leave out what is compared with."""

    def visit_Match(self, node: ast.Match) -> None:
        """Leave out what is compared with."""
        for case in node.cases:
            for statement in case.body:
                self.visit(statement)

    def visit_Dict(self, node: ast.Dict) -> None:
        """Leave out keys, and what describes an API."""
        for name, value in zip(node.keys, node.values, strict=True):
            if not (isinstance(name, ast.Constant) and name.value in SILENT_FIELDS):
                self.visit(value)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Read an f-string as one sentence, or one for each choice of words in it."""
        for text in islice(_variants(node), MOST_VARIANTS):
            self._keep(node, text)
        for part in node.values:
            if isinstance(part, ast.FormattedValue) and not _is_choice(part.value):
                self._words_within(part.value)

    def _words_within(self, node: ast.expr) -> None:
        """Read the words that an expression in a gap chooses from, be they as short as `on`."""
        for inner in ast.walk(node):
            if isinstance(inner, ast.IfExp):
                for branch in (inner.body, inner.orelse):
                    if (
                        isinstance(branch, ast.Constant)
                        and isinstance(branch.value, str)
                        and _is_word(branch.value)
                    ):
                        self.found.append((branch.lineno, branch.value))
        self.visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        """Read a text."""
        if isinstance(node.value, str):
            self._keep(node, node.value)

    def _keep(self, node: ast.expr, text: str) -> None:
        if is_for_people(text):
            self.found.append((node.lineno, text))


def is_for_people(text: str) -> bool:
    """Return whether a text reads like a sentence or a label, not like something for a program."""
    literal = GAP.sub(" ", text)
    if MACHINE.search(text) or not WORD.search(literal) or text != text.strip():
        return False
    if " " not in text:
        return LABEL.fullmatch(text) is not None
    shortest = 2 if literal != text else 3
    words = WORD.findall(literal)
    return any(word.islower() and len(word) >= shortest for word in words) or LABEL.match(text) is not None


def _is_word(text: str) -> bool:
    return WORD.fullmatch(text) is not None and not MACHINE.search(text)


def _called(node: ast.expr) -> str:
    match node:
        case ast.Name(id=name):
            return name
        case ast.Attribute(attr=name):
            return name
        case _:
            return ""


def _is_choice(node: ast.expr) -> bool:
    """Return whether an expression chooses between two texts."""
    return isinstance(node, ast.IfExp) and all(_is_text(branch) for branch in (node.body, node.orelse))


def _is_text(node: ast.expr) -> bool:
    return (
        isinstance(node, ast.JoinedStr)
        or (isinstance(node, ast.Constant) and isinstance(node.value, str))
        or _is_choice(node)
    )


def _variants(node: ast.JoinedStr) -> Iterator[str]:
    """Return the sentence that an f-string makes, with named gaps, once for each choice of words."""
    for parts in product(*(_part(value) for value in node.values)):
        taken: dict[str, int] = {}
        yield "".join(_piece(part, taken) for part in parts)


def _part(node: ast.expr) -> Iterable[str | ast.expr]:
    """Return what may stand at one place: a text, one of several texts, or a gap."""
    match node:
        case ast.Constant(value=str(text)):
            return (text,)
        case ast.FormattedValue(value=value) if _is_choice(value):
            return tuple(_choices(value))
        case ast.FormattedValue(value=value):
            return (value,)
        case _:
            return (node,)


def _choices(node: ast.expr) -> Iterator[str]:
    match node:
        case ast.IfExp(body=body, orelse=orelse):
            yield from _choices(body)
            yield from _choices(orelse)
        case ast.JoinedStr():
            yield from islice(_variants(node), MOST_VARIANTS)
        case ast.Constant(value=str(text)):
            yield text


def _piece(part: str | ast.expr, taken: dict[str, int]) -> str:
    if isinstance(part, str):
        return GAP.sub(lambda gap: _gap(gap[1], taken), part)
    return _gap(gap_name(part), taken)


def _gap(name: str, taken: dict[str, int]) -> str:
    """Return a gap whose name no other gap of the sentence has."""
    taken[name] = taken.get(name, 0) + 1
    return f"{{{name}}}" if taken[name] == 1 else f"{{{name}{taken[name]}}}"


def gap_name(node: ast.expr) -> str:
    """Return what to call a gap: the last name of the expression that fills it."""
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name.lower().strip("_") or "value"
        case ast.Call(args=[ast.Name() | ast.Attribute() as inner, *_]):
            return gap_name(inner)
        case ast.Call(func=ast.Name(id=name), args=[inner, *_]) if name in PLAIN_CALLS:
            return gap_name(inner)
        case ast.Call(func=func):
            return gap_name(func)
        case _:
            inside = next((part for part in INSIDE if hasattr(node, part)), None)
            return gap_name(getattr(node, inside)) if inside else "value"


INSIDE = ("value", "operand", "left", "elt", "body")
"""Where the chief part of an expression stands: a subscript, a negation, a sum, a comprehension, a choice."""
