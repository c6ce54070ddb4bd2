"""Which build of the panel and which life of the machine a page was made by, as one word in every page."""

import hashlib
import re
from functools import cache

from app.base.message import N_
from app.base.own import PROGRAM, own_folder
from app.tracker.state.snapshot import SiteSnapshot

PARTS = ((PROGRAM, "*.py"), (own_folder("templates"), "*.html"), (own_folder("static"), "*"))
LENGTH = 12
MARK = re.compile(r"([0-9a-f]{12})\.([A-Za-z0-9_-]{0,64})")


class PageOutdated(Exception):
    """A page of another build, or from before the machine's last start, orders something."""

    def __init__(self) -> None:
        super().__init__(N_("This page is outdated and is being reloaded. Then repeat the action."))


@cache
def edition() -> str:
    """Return the word for this build: it differs when program, templates, scripts or styles do."""
    total = hashlib.sha256()
    for folder, pattern in PARTS:
        for path in sorted(folder.rglob(pattern)):
            if path.is_file():
                total.update(str(path.relative_to(folder)).encode())
                total.update(path.read_bytes())
    return total.hexdigest()[:LENGTH]


def mark_of(site: SiteSnapshot | None) -> str:
    """Return the mark of a page that is made now; without a machine its life stays open."""
    return f"{edition()}.{site.boot_id if site else ''}"


def refuse_outdated(mark: str, site: SiteSnapshot | None) -> None:
    """Raise `PageOutdated` for the mark of another build or another life; what is no mark says nothing."""
    found = MARK.fullmatch(mark)
    if found is None:
        return
    build, life = found.groups()
    if build != edition() or (site is not None and life not in ("", site.boot_id)):
        raise PageOutdated
