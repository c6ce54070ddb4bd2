"""The blocks of the documents that the guide shows, for the catalogues."""

from collections.abc import Iterator
from pathlib import Path
from typing import IO

from app.web.features.guide import guide, rendering
from app.web.languages.catalogue import DOCUMENTS


def extract(
    file: IO[bytes], _keywords: object, _comments: object, **_options: object
) -> Iterator[tuple[int, str, tuple[str, str], list[str]]]:
    """Tell Babel every block of a document that is translated."""
    path = Path(file.name)
    for name in guide.SPOKEN:
        if path.match(f"docs/{guide.PLACES[name]}.md"):
            for line, markdown in rendering.blocks(name):
                yield line, "pgettext", (DOCUMENTS, markdown), []
