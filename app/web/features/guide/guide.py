"""The documents as pages, offline: which there are, and their sections in the reader's language."""

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from urllib.parse import urlsplit

from markupsafe import Markup

from app.base.message import N_
from app.base.own import own_folder
from app.base.startup import late
from app.web.languages import CATALOGUE, IN_ENGLISH
from app.web.languages.catalogue import Catalogue
from app.web.languages.known import ENGLISH, TRANSLATED

DOCS = own_folder("docs")
GUIDE = "operators-guide"
SHOWN = {
    "operate/operators-guide": N_("Operator's guide"),
    "explain/strategies": N_("Strategies"),
    "explain/mounts": N_("Mounts"),
    "explain/studies": N_("Studies"),
    "explain/papers": N_("The five papers"),
    "reference/faults": N_("Faults"),
    "reference/glossary": N_("Glossary"),
    "integrate/integrators-guide": N_("Integrator's guide"),
    "integrate/sunspec": "SunSpec",
    "integrate/mqtt": N_("MQTT"),
}
"""The documents that the panel shows, by where they are in the folder of documents."""
PLACES = {place.rpartition("/")[2]: place for place in SHOWN}
TITLES = {name: SHOWN[place] for name, place in PLACES.items()}
"""Their titles by the name of their file, which their pages are called by."""
SPOKEN = (GUIDE, "strategies", "mounts", "studies", "glossary")
"""Those of them that are shown in the reader's language; the others are for who programs and stay English."""
MOST_KEPT = len(TITLES) + len(SPOKEN) * len(TRANSLATED)
RENDERING = "app.web.features.guide.rendering"
"""Loaded with the first document that is read: most processes never show one."""

SECTIONS = "|".join(sorted({place.partition("/")[0] for place in SHOWN}))
FOLDERS = re.compile(rf"(?<=\]\()(?:\.\./)+(?:(?:{SECTIONS})/)?")
"""The folders in a link to another document: left out, so that a document may move and stays translated."""
PICTURE = re.compile(r"pictures/([\w-]+\.png)")
UNSEEN = re.compile("[\u0300-\u036f\u00ad]")
"""Marks on letters, and where a long word may be broken: nobody has to type them."""


@dataclass(frozen=True, slots=True)
class GuideSection:
    """One section below a heading: its anchor, level (1 to 3), title, HTML, and its words for searching.

    Title, HTML and words are in the reader's language; the anchor is the English one, so that links hold.
    """

    anchor: str
    level: int
    title: str
    html: Markup
    words: str


def picture(name: str) -> Path | None:
    """Return the file of a picture of the documents, None if there is none of that name."""
    path = DOCS / "pictures" / name
    return path if PICTURE.fullmatch(f"pictures/{name}") and path.is_file() else None


def sections(document: str) -> tuple[GuideSection, ...]:
    """Return the sections of a document in the language of the request, in English where it is not spoken."""
    return _sections(document, CATALOGUE.get() if document in SPOKEN else IN_ENGLISH)


def is_foreign(document: str) -> bool:
    """Return whether a document is English although the reader's language is another."""
    return document not in SPOKEN and CATALOGUE.get().language is not ENGLISH


@lru_cache(maxsize=MOST_KEPT)
def _sections(document: str, catalogue: Catalogue) -> tuple[GuideSection, ...]:
    told: tuple[GuideSection, ...] = late(RENDERING).sections_of(text_of(document), catalogue)
    return told


def text_of(document: str) -> str:
    """Return the Markdown of a document."""
    return FOLDERS.sub("", (DOCS / f"{PLACES[document]}.md").read_text())


def all_sections() -> Iterator[tuple[str, GuideSection]]:
    """Return every section of every document in the language of the request, with the document's name."""
    for document in TITLES:
        for section in sections(document):
            yield document, section


def folded(text: str) -> str:
    """Return a text as a search compares it: in small letters, without marks and soft hyphens."""
    return UNSEEN.sub("", unicodedata.normalize("NFKD", text.casefold())).replace("ı", "i")


def slug(title: str) -> str:
    """Return the anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def here(href: str) -> str:
    """Return where a link of a document leads in the panel; empty where the panel does not have it."""
    parts = urlsplit(href)
    if parts.scheme or parts.netloc:
        return ""
    if not parts.path:
        return f"#{parts.fragment}"
    name = parts.path.removesuffix(".md")
    if name not in TITLES:
        return ""
    return f"/guide/{name}" + (f"#{parts.fragment}" if parts.fragment else "")
