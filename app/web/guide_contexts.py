"""What the templates of the documents and of the search are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.web.contexts import Frame
from app.web.guide import GuideSection


@dataclass(frozen=True, slots=True)
class GuidePage:
    """One document, its sections and the list of all documents by their names."""

    template: ClassVar[str] = "guide.html"

    frame: Frame
    name: str
    title: str
    sections: tuple[GuideSection, ...]
    titles: dict[str, str]


@dataclass(frozen=True, slots=True)
class Hit:
    """Something that a search found: what kind of thing, its name, where it is, a few words about it."""

    kind: str
    title: str
    href: str
    text: str


@dataclass(frozen=True, slots=True)
class SearchPage:
    """What was searched for and found."""

    template: ClassVar[str] = "search.html"

    frame: Frame
    words: str
    hits: tuple[Hit, ...]
