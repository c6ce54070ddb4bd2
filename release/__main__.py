"""Makes a release: `python -m release x.y.z`; with `--dry-run` nothing but what is built is kept.

All of it happens in a temporary clone of the last commit. Only when everything is built do the commit and the
tag come here, so that what fails leaves nothing behind.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from datetime import UTC, date, datetime, time
from pathlib import Path

from babel.messages.pofile import read_po

from app.web.translation.catalogues import untranslated as missing_in
from release.artifacts import build
from release.changelog import released
from release.refused import Refused

VERSION = re.compile(r"\d+\.\d+\.\d+")
IN_BUILD = re.compile(r'^VERSION = "(?P<version>[^"]+)"$', re.MULTILINE)
BUILT_AT = re.compile(r"^BUILT_AT = datetime\(.*\)$", re.MULTILINE)
BUILD, CHANGELOG, DATABASES = "app/base/build.py", "CHANGELOG.md", "tests/golden/databases"


def main() -> int:
    """Make a release of the project in the present folder and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m release")
    parser.add_argument("version")
    parser.add_argument(
        "--dry-run", action="store_true", help="Build everything; commit and tag nothing here."
    )
    given = parser.parse_args()
    try:
        make(Path.cwd(), given.version, datetime.now(UTC).date(), dry_run=given.dry_run)
    except Refused as refusal:
        sys.stderr.write(f"{refusal}\n")
        return 2
    except subprocess.CalledProcessError as failure:
        sys.stderr.write(f"{failure} Nothing was committed.\n{failure.stderr or ''}")
        return 1
    return 0


def make(root: Path, version: str, day: date, *, dry_run: bool) -> None:
    """Raise the version, build everything into dist/VERSION, commit and tag."""
    target = root / "dist" / version
    check(root, version, target)
    with tempfile.TemporaryDirectory() as name:
        clone, made = Path(name) / "heliopanel", Path(name) / "made"
        git(root, "clone", "--quiet", "--no-hardlinks", str(root), str(clone))
        for setting in ("user.name", "user.email"):
            git(clone, "config", setting, git(root, "config", setting) or "Heliopanel")
        raise_version(clone, version, day)
        git(clone, "add", "--all")
        git(clone, "commit", "--quiet", "--allow-empty", "-m", f"release: {version}")
        git(clone, "tag", "--annotate", f"v{version}", "-m", f"Heliopanel {version}")
        left_out = build(clone, made, version, datetime.combine(day, time(), UTC))
        if not dry_run:
            git(root, "fetch", "--quiet", str(clone), "HEAD", "tag", f"v{version}")
            git(root, "merge", "--quiet", "--ff-only", f"v{version}")
        shutil.move(made, target)
    said = "would be" if dry_run else "is"
    sys.stdout.write("".join(f"{one.name}\n" for one in sorted(target.iterdir())))
    sys.stdout.write("".join(f"{one}\n" for one in left_out))
    sys.stdout.write(
        f"Heliopanel {version} {said} committed and tagged v{version}; its files are in {target}.\n"
    )


def check(root: Path, version: str, target: Path) -> None:
    """Raise `Refused` where this version cannot be released from here."""
    if not VERSION.fullmatch(version):
        raise Refused(f"{version!r} is no version: say three numbers, such as 1.2.0.")
    present = present_version(root)
    if numbers(version) < numbers(present):
        raise Refused(f"{version} is older than the present version, {present}.")
    if git(root, "status", "--porcelain"):
        raise Refused("There are changes that are not committed. Commit or remove them first.")
    if git(root, "tag", "--list", f"v{version}"):
        raise Refused(f"{version} is released already: there is the tag v{version}.")
    for told in untranslated(root):
        raise Refused(told)
    if target.exists():
        raise Refused(f"{target} is there already. Remove it first.")
    released((root / CHANGELOG).read_text(), version, date.min)


def untranslated(root: Path) -> Iterator[str]:
    """Yield the languages that do not have every text: until a release these are shown in English."""
    for path in sorted((root / "app/web/locale").glob("*/LC_MESSAGES/*.po")):
        with path.open("rb") as stored:
            missing = missing_in(read_po(stored))
        if missing:
            yield f"{path.relative_to(root)} does not translate {len(missing)} texts, first {missing[0]!r}."


def raise_version(sources: Path, version: str, day: date) -> None:
    """Raise the version in its one place, and renew what is made from it."""
    build_file = sources / BUILD
    text = IN_BUILD.sub(f'VERSION = "{version}"', build_file.read_text())
    text = BUILT_AT.sub(f"BUILT_AT = datetime({day.year}, {day.month}, {day.day}, tzinfo=UTC)", text)
    build_file.write_text(text)
    changelog = sources / CHANGELOG
    changelog.write_text(released(changelog.read_text(), version, day))
    run(sources, "app.web.openapi")
    if not (sources / DATABASES / version).exists():
        run(sources, "tests.golden.databases", version)


def present_version(sources: Path) -> str:
    """Return the version of a checkout, read without running it."""
    found = IN_BUILD.search((sources / BUILD).read_text())
    if found is None:
        raise Refused(f"{BUILD} does not say which version this is.")
    return found["version"]


def numbers(version: str) -> list[int]:
    """Return a version as what it is ordered by."""
    return [int(part) for part in version.split(".")]


def run(sources: Path, module: str, *arguments: str) -> None:
    """Run a module of a checkout."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("HELIOPANEL_")}
    environment["PYTHONPATH"] = str(sources)
    command = [sys.executable, "-m", module, *arguments]
    subprocess.run(command, cwd=sources, env=environment, check=True, capture_output=True, text=True)


def git(folder: Path, *words: str) -> str:
    """Run git in a folder and return what it said; a setting that is not there is no failure."""
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True)
    if done.returncode and words[0] != "config":
        done.check_returncode()
    return done.stdout.strip()


if __name__ == "__main__":
    sys.exit(main())
