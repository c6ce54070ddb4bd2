"""Each lock is whole: what a locked library requires is locked too, so that no installer has to resolve."""

import re
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import Distribution, distributions
from itertools import product
from pathlib import Path

import pytest
from packaging.markers import Marker, default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
OWN = "heliopanel"
LINE = re.compile(r"^([\w.-]+)==([^\s;\\]+)(?:\s*;\s*([^\\\n]+?))?\s*\\?$", re.MULTILINE)
RUNTIME = [f"{OWN}[build,all]"]
LOCKS = {
    "requirements.txt": RUNTIME,
    "requirements-fast.txt": [f"{OWN}[build,all,fast]"],
    "requirements-test.txt": [f"{OWN}[build,all,mdns,test]"],
    "requirements-dev.txt": [f"{OWN}[build,all,dev]"],
    "requirements-client.txt": PROJECT["dependency-groups"]["client"],
    "requirements-uv.txt": PROJECT["dependency-groups"]["uv"],
}
HERE = ("requirements.txt", "requirements-test.txt", "requirements-uv.txt")
"""What the gate installs; `make soak PART=built` asks of the others (tests/soak/built/)."""
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
PROCESSORS = ("x86_64", "aarch64")


def computers() -> Iterator[dict[str, str]]:
    """Yield what markers are judged by: a Linux with each Python and processor that we support."""
    for python, processor in product(PYTHONS, PROCESSORS):
        found = {name: str(value) for name, value in default_environment().items()}
        yield found | {
            "python_version": python,
            "python_full_version": f"{python}.2",
            "platform_machine": processor,
        }


def holds(marker: Marker | None, computer: dict[str, str], extra: str = "") -> bool:
    return marker is None or marker.evaluate(computer | {"extra": extra})


def locked(text: str, computer: dict[str, str]) -> dict[str, str]:
    """Return name and version of what a lock installs on a computer."""
    return {
        canonicalize_name(name): version
        for name, version, marker in LINE.findall(text)
        if holds(Marker(marker) if marker else None, computer)
    }


def installed(lock: str) -> dict[str, Distribution]:
    """Return what says what it requires: the libraries that were installed from the lock."""
    folder = Path(sys.prefix, "client") if lock == "requirements-client.txt" else Path(sys.prefix)
    found = {
        canonicalize_name(one.name): one
        for one in distributions(path=[str(path) for path in folder.glob("lib/python*/site-packages")])
    }
    assert found, f"{lock} is not installed here: run make test, or make soak PART=built, which does."
    return found


def required(by: str, extra: str, known: dict[str, Distribution]) -> list[Requirement]:
    """Return what a library requires with one of its extras; ours is read as it stands in pyproject.toml."""
    if by != OWN:
        return [Requirement(one) for one in (known[by].requires or ())] if by in known else []
    more = PROJECT["project"]["optional-dependencies"]
    return [Requirement(one) for one in (more[extra] if extra else PROJECT["project"]["dependencies"])]


def missing(
    roots: list[str], lock: dict[str, str], known: dict[str, Distribution], computer: dict[str, str]
) -> tuple[set[str], set[str]]:
    """Return which requirements the lock does not meet, and all libraries that were asked for."""
    unmet: set[str] = set()
    waiting = [("the roots", Requirement(root)) for root in roots]
    asked: set[tuple[str, str]] = set()
    while waiting:
        by, needed = waiting.pop()
        name = canonicalize_name(needed.name)
        if name != OWN and not needed.specifier.contains(lock.get(name, "0.dev0"), prereleases=True):
            unmet.add(f"{by} requires {needed}, locked is {lock.get(name, 'none')}")
        for extra in {"", *needed.extras}:
            if (name, extra) not in asked:
                asked.add((name, extra))
                waiting += [
                    (name, one) for one in required(name, extra, known) if holds(one.marker, computer, extra)
                ]
    return unmet, {name for name, _ in asked} - {OWN}


@pytest.mark.parametrize("name", HERE)
def test_a_lock_meets_every_requirement_of_what_it_locks(name: str) -> None:
    text, known = (ROOT / name).read_text(), installed(name)
    for computer in computers():
        unmet, asked = missing(LOCKS[name], locked(text, computer), known, computer)
        assert unmet == set()
        assert len(asked) > 15 or name == "requirements-uv.txt"
        assert asked <= locked(text, computer).keys()


@pytest.mark.parametrize("name", HERE)
def test_what_is_installed_here_is_what_the_lock_says(name: str) -> None:
    here = {key: str(value) for key, value in default_environment().items()}
    known = installed(name)
    wrong = {
        one: (version, known[one].version if one in known else None)
        for one, version in locked((ROOT / name).read_text(), here).items()
        if one not in known or known[one].version != version
    }
    assert wrong == {}, "Run make test, or remove .venv: it was made from another lock."


def test_a_library_that_is_not_locked_is_found() -> None:
    """What an extra of a locked library requires counts as well: psycopg is asked for as psycopg[binary]."""
    text, known = (ROOT / "requirements.txt").read_text(), installed("requirements.txt")
    computer = next(computers())
    whole = locked(text, computer)
    lock = {name: version for name, version in whole.items() if name != "psycopg-binary"}
    unmet, _ = missing(RUNTIME, lock, known, computer)
    assert unmet
    assert all("requires psycopg-binary" in one for one in unmet), unmet
    unmet, _ = missing(RUNTIME, whole | {"starlette": "0.1"}, known, computer)
    assert [one for one in unmet if one.startswith("fastapi requires starlette")]
