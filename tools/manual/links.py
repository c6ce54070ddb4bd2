"""Finds what leads nowhere in a built site, what comes from elsewhere, and what no strict policy lets run."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADS = {"script": "src", "img": "src", "source": "src", "iframe": "src", "link": "href"}
"""What a browser fetches by itself, by element: the address is in this attribute."""

FETCHED_LATER = ("mermaid", "glightbox")
"""Classes of elements that the generator's script would fetch a library from elsewhere for."""


@dataclass
class Page(HTMLParser):
    """What a page has to be led to, and what it leads to and loads."""

    path: Path
    anchors: set[str] = field(default_factory=lambda: {""})
    links: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)
    inline: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Read it."""
        super().__init__()
        self.feed(self.path.read_text())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what an element says."""
        said = {name: value or "" for name, value in attrs}
        self.anchors |= {said[name] for name in ("id", "name") if name in said}
        if tag == "a" and "href" in said:
            self.links.append(said["href"])
        if address := said.get(LOADS.get(tag, "")):
            (self.links if said.get("rel") in ("prev", "next") else self.loaded).append(address)
        if tag == "script" and "src" not in said and said.get("type") != "application/json":
            self.inline.append("a script in the page")
        self.inline += [f"{name}={said[name]}" for name in said if name == "style" or name.startswith("on")]
        self.inline += [name for name in FETCHED_LATER if name in said.get("class", "").split()]


def faults(site: Path) -> list[str]:
    """Return a sentence for everything that is wrong."""
    pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
    return [
        f"{page.path.relative_to(site)}: {fault}"
        for page in pages.values()
        for fault in (*_astray(page, pages, site), *_foreign(page), *_unrunnable(page))
    ] + list(_unlisted(site))


def _astray(page: Page, pages: dict[Path, Page], site: Path) -> Iterator[str]:
    for address in (*page.links, *page.loaded):
        parts = urlsplit(address)
        if parts.scheme or parts.netloc:
            continue
        target = (page.path.parent / unquote(parts.path)).resolve() if parts.path else page.path
        if not target.is_relative_to(site) or not target.is_file():
            yield f"{address} is not there"
        elif target in pages and unquote(parts.fragment) not in pages[target].anchors:
            yield f"{address} has no such anchor"


def _foreign(page: Page) -> Iterator[str]:
    for address in page.loaded:
        if urlsplit(address).netloc:
            yield f"{address} is loaded from elsewhere"


def _unrunnable(page: Page) -> Iterator[str]:
    for what in page.inline:
        yield f"{what}: the panel's security policy does not allow it"


def _unlisted(site: Path) -> Iterator[str]:
    """Yield pages that a search would not find."""
    items = json.loads((site / "search.json").read_text())["items"]
    found = {item["location"].partition("#")[0] for item in items}
    for path in sorted(site.rglob("*.html")):
        name = str(path.relative_to(site))
        if name not in found:
            yield f"{name}: the search does not know it"
