"""Nothing that git knows looks like a secret; where something does is told, never what."""

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

RULES = {
    "private key": re.compile(r"-----BEGIN [A-Z ]*PRIVATE KEY-----"),
    "password": re.compile(
        r"(?i)\b(?:password|passwd|secret|api_?key)\s*[:=]\s*[\"'][^\"'\s{}$<>]{12,}[\"']"
    ),
    "token of this panel": re.compile(r"\bhp_[A-Za-z0-9]{30,}"),
    "cloud key": re.compile(
        r"\b(?:AKIA[0-9A-Z]{16}|gh[pousr]_[A-Za-z0-9]{36}|xox[baprs]-[A-Za-z0-9-]{10,})\b"
    ),
    "password in an address": re.compile(r"\b[a-z][a-z0-9+]*://[^\s/:@\"']+:[^\s/:@\"'{}<>*]{6,}@"),
}
ALLOWED = re.compile(r"^(tests/|docs/openapi\.json|static/vendor/|requirements.*\.txt)")
"""Where made-up passwords and hashes are to be expected; private keys are looked for there too."""

LONGEST = 2_000_000


@dataclass(frozen=True, slots=True)
class Finding:
    """Where something that looks like a secret stands, and which rule it fits."""

    path: str
    line: int
    rule: str


def findings(root: Path) -> list[Finding]:
    """Return what looks like a secret in the files that git knows."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z"], check=True, capture_output=True)
    names = [name for name in listed.stdout.decode().split("\0") if name]
    return [found for name in names for found in _in_file(root / name, name)]


def _in_file(path: Path, name: str) -> list[Finding]:
    if not path.is_file() or path.stat().st_size > LONGEST:
        return []
    text = path.read_bytes().decode("utf-8", "ignore")
    rules = {"private key": RULES["private key"]} if ALLOWED.match(name) else RULES
    return [
        Finding(name, text.count("\n", 0, match.start()) + 1, rule)
        for rule, pattern in rules.items()
        for match in pattern.finditer(text)
    ]


def faults() -> Iterator[str]:
    """Yield where something was found, and never what."""
    for one in findings(Path(__file__).resolve().parents[1]):
        yield f"{one.path}:{one.line}: {one.rule}: take it out, and make a new one if it was pushed."
