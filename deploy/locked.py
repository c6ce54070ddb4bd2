"""Install locked libraries into the environment whose Python runs this: `python deploy/locked.py LOCK`.

uv installs them in seconds, where pip finds it for this computer (`requirements-uv.txt`); else pip does, in
a minute. Both use the index, certificates, and proxy that pip is set up with. A lock is whole, so that
nothing is resolved, and each file must have the checksum that stands in it. Folders that are named after the
lock, such as the project's own, are installed as they are, without what they depend on. It needs the standard
library alone.
"""

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

UV = Path(sys.executable).with_name("uv")
UV_LOCK = Path(__file__).parents[1] / "requirements-uv.txt"
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check")
AS_IT_IS = ("--no-deps", "--no-build-isolation", "--editable")
LOCKED = ("--no-deps", "--require-hashes", "-r")
VARIABLES = {
    "cert": "SSL_CERT_FILE",
    "client-cert": "SSL_CLIENT_CERT",
    "proxy": "ALL_PROXY",
    "default-timeout": "UV_HTTP_TIMEOUT",
    "timeout": "UV_HTTP_TIMEOUT",
}
OPTIONS = {
    "index-url": "--default-index",
    "extra-index-url": "--index",
    "find-links": "--find-links",
    "trusted-host": "--allow-insecure-host",
}
"""What uv calls the settings of pip, by pip's names."""
LATER_WINS = ("global", "user", "site", "install", ":env:")
"""Where pip finds its settings, from the first to the last that counts."""


def settings_of_pip(listed: str) -> dict[str, str]:
    """Return the settings that `pip config list` shows, each from the place that counts for `pip install`."""
    found: dict[str, tuple[int, str]] = {}
    for line in listed.splitlines():
        name, _, value = line.partition("=")
        place, _, setting = name.rpartition(".")
        rank = LATER_WINS.index(place) if place in LATER_WINS else -1
        if rank >= found.get(setting, (0, ""))[0]:
            found[setting] = (rank, " ".join(value.strip("'\"").replace("\\n", " ").split()))
    return {setting: value for setting, (_, value) in found.items()}


def options(settings: Mapping[str, str]) -> list[str]:
    """Return the options that have uv look where pip looks.

    Each file has its checksum in the lock: it does not matter which index it comes from.
    """
    found = ["--no-config", "--index-strategy", "unsafe-best-match"]
    for setting, option in OPTIONS.items():
        for value in settings.get(setting, "").split():
            found += [option, value]
    return found + ["--no-index"] * (settings.get("no-index", "").lower() in ("1", "true", "yes", "on"))


def environment(settings: Mapping[str, str], given: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of uv; what is set for uv itself wins over what pip is set up with."""
    chosen = {VARIABLES[one]: value for one, value in settings.items() if one in VARIABLES}
    return chosen | dict(given)


def has_uv() -> bool:
    """Return whether uv is there, after pip was asked for the version that is locked."""
    if UV_LOCK.read_text().split()[0] != f"uv=={_installed_uv()}":
        subprocess.run(
            [*PIP, "install", "--quiet", "--no-compile", *LOCKED, UV_LOCK], capture_output=True, check=False
        )
    return UV.exists()


def _installed_uv() -> str:
    try:
        return version("uv")
    except PackageNotFoundError:
        return ""


def by_uv(lock: str, projects: Sequence[str]) -> bool:
    """Return whether uv could install everything; why not does not matter, since pip says it then."""
    listed = subprocess.run([*PIP, "config", "list"], capture_output=True, text=True, check=False).stdout
    settings = settings_of_pip(listed)
    install = [UV, "pip", "install", "--python", sys.executable, *options(settings)]
    env = environment(settings, os.environ)
    return all(
        subprocess.run([*install, *what], env=env, capture_output=True, check=False).returncode == 0
        for what in wanted(lock, projects)
    )


def by_pip(lock: str, projects: Sequence[str]) -> bool:
    """Return whether pip could install everything."""
    install = [*PIP, "install", "--quiet"]
    return all(
        subprocess.run([*install, *what], check=False).returncode == 0 for what in wanted(lock, projects)
    )


def wanted(lock: str, projects: Sequence[str]) -> list[list[str]]:
    """Return what is asked of an installer: the lock, and each project."""
    return [[*LOCKED, lock], *([*AS_IT_IS, one] for one in projects)]


def fit() -> bool:
    """Return whether every library finds what it needs, and say what does not."""
    check = [UV, "pip", "check", "--python", sys.executable] if UV.exists() else [*PIP, "check"]
    found = subprocess.run(check, capture_output=True, text=True, check=False)
    if found.returncode:
        print(found.stdout + found.stderr, file=sys.stderr)
        print(
            f"These libraries do not fit together. Remove {sys.prefix} and run the command again.",
            file=sys.stderr,
        )
    return found.returncode == 0


def main(lock: str, *projects: str) -> int:
    """Install a lock, then projects as they are, and return 0 if all of it is there and fits together."""
    if not (has_uv() and by_uv(lock, projects)):
        print("Installing with pip, which takes a minute ...", flush=True)
        if not by_pip(lock, projects):
            return 1
    return 0 if fit() else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
