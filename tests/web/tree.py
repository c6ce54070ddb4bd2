"""A page as its elements."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser

VOID = frozenset(("area", "base", "br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"))


@dataclass(eq=False)
class Tag:
    """An element of a page, and the text that stands in it itself."""

    name: str
    given: dict[str, str]
    above: "Tag | None" = None
    below: list["Tag"] = field(default_factory=list)
    text: str = ""

    @property
    def all(self) -> Iterator["Tag"]:
        """Yield everything within it, in the order of the page."""
        for child in self.below:
            yield child
            yield from child.all

    def named(self, *names: str) -> list["Tag"]:
        """Return the elements of these names within it."""
        return [one for one in self.all if one.name in names]

    def is_a(self, style: str) -> bool:
        """Return whether it has this class."""
        return style in self.given.get("class", "").split()

    def __str__(self) -> str:
        return f"<{self.name} {' '.join(f'{name}={value}' for name, value in self.given.items())}>"


class _Tree(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.root = self._at = Tag("", {})
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_startendtag(tag, attrs)
        if tag not in VOID:
            self._at = self._at.below[-1]

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._at.below.append(Tag(tag, {name: value or "" for name, value in attrs}, self._at))

    def handle_endtag(self, tag: str) -> None:
        one: Tag | None = self._at
        while one is not None and one.name != tag:
            one = one.above
        if one is not None and one.above is not None:
            self._at = one.above

    def handle_data(self, data: str) -> None:
        self._at.text += data


def tree(page: str) -> Tag:
    """Return a page, or a part of one, as what stands above all its elements."""
    return _Tree(page).root
