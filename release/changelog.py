"""The section of a version in CHANGELOG.md."""

import re
from datetime import date

from release.refused import Refused

UNRELEASED = "## [Unreleased]"


def released(text: str, version: str, day: date) -> str:
    """Return a changelog in which a version has its section: what stands under Unreleased is it from now on.

    A section that was written beforehand stays as it is; then nothing may stand under Unreleased.
    """
    waiting = section(text, UNRELEASED)
    if waiting is None:
        raise Refused(f"CHANGELOG.md has no heading {UNRELEASED}.")
    dated = re.search(rf"^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$", text, re.MULTILINE)
    if dated is None:
        if not waiting:
            raise Refused(
                f"CHANGELOG.md tells nothing of {version}: write under Unreleased what users notice."
            )
        return text.replace(UNRELEASED, f"{UNRELEASED}\n\n## [{version}] - {day}", 1)
    if waiting:
        raise Refused(f"CHANGELOG.md has a section of {version}, and more under Unreleased: join them.")
    if not section(text, dated.group()):
        raise Refused(f"The section of {version} in CHANGELOG.md is empty.")
    return text


def section(text: str, heading: str) -> str | None:
    """Return what stands under a heading, None without that heading."""
    _, found, after = text.partition(f"{heading}\n")
    return re.split(r"^## ", after, maxsplit=1, flags=re.MULTILINE)[0].strip() if found else None
