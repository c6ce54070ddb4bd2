"""What the templates of the documents and of the search are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.web.features.guide.guide import GuideSection
from app.web.shell.contexts import Frame, Link


@dataclass(frozen=True, slots=True)
class GuidePage:
    """One document, its sections and the list of all documents; `is_foreign` where only English is there.

    `has_manual` where the site of all documents was built.
    """

    template: ClassVar[str] = "guide.html"

    frame: Frame
    name: str
    title: str
    sections: tuple[GuideSection, ...]
    titles: dict[str, str]
    is_foreign: bool
    has_manual: bool


@dataclass(frozen=True, slots=True)
class Hit:
    """Something that a search found: what kind of thing, its name, where it is, a few words about it.

    A section of a document is told as the document is shown, `is_foreign` where that is English for want of
    a translation; all else is English and is said in the reader's language by the page. `others` lead to
    the same place of other trackers.
    """

    kind: str
    title: str
    href: str
    text: str
    others: tuple[Link, ...] = ()
    is_foreign: bool = False


@dataclass(frozen=True, slots=True)
class SearchPage:
    """What was searched for and found; `is_near` where nothing has all the words."""

    template: ClassVar[str] = "search.html"

    frame: Frame
    words: str
    hits: tuple[Hit, ...]
    is_near: bool
