"""`python -m tools.manual [FOLDER]` builds the site of the documents, into `manual` by default."""

import sys
from pathlib import Path

from tools.manual.site import ROOT, BrokenSite, build


def main(words: list[str]) -> int:
    """Build it; print what is wrong with it. Return the exit code."""
    target = Path(words[0]) if words else ROOT / "manual"
    try:
        build(target.resolve())
    except BrokenSite as error:
        sys.stderr.write(f"{error}\n")
        return 1
    sys.stdout.write(f"The manual is in {target}: open index.html, or /manual/ of a panel that is served.\n")
    return 0


sys.exit(main(sys.argv[1:]))
