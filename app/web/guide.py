"""The documents as pages: Markdown rendered on the server, with sections, anchors and pictures, offline."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from markdown_it.utils import EnvType, OptionsDict
from markupsafe import Markup, escape

DOCS = Path(__file__).resolve().parents[2] / "docs"
GUIDE = "operators-guide"
TITLES = {
    GUIDE: "Operator's guide",
    "strategies": "Strategies",
    "mounts": "Mounts",
    "studies": "Studies",
    "papers": "The five papers",
    "faults": "Faults",
    "glossary": "Glossary",
    "integrators-guide": "Integrator's guide",
    "sunspec": "SunSpec",
    "mqtt": "MQTT",
}
"""The documents that the panel shows, by the name of their file."""

ANCHOR = re.compile(r'<a id="[\w.-]+">|</a>')
PICTURE = re.compile(r"pictures/([\w-]+\.png)")


@dataclass(frozen=True, slots=True)
class GuideSection:
    """One section below a heading: its anchor, level (1 to 3), title, HTML, and its words for searching."""

    anchor: str
    level: int
    title: str
    html: Markup
    words: str


def picture(name: str) -> Path | None:
    """Return the file of a picture of the documents, None if there is none of that name."""
    path = DOCS / "pictures" / name
    return path if PICTURE.fullmatch(f"pictures/{name}") and path.is_file() else None


@cache
def sections(document: str) -> tuple[GuideSection, ...]:
    """Return the sections of a document."""
    parser = _parser()
    tokens = parser.parse((DOCS / f"{document}.md").read_text())
    return tuple(_section(parser, part) for part in _parts(tokens))


def rendered(text: str) -> str:
    """Return Markdown as HTML."""
    return str(_parser().render(text))


def _parser() -> MarkdownIt:
    return MarkdownIt("commonmark", renderer_cls=_Pages).enable("table")


def found(wanted: str) -> list[tuple[str, GuideSection]]:
    """Return every section of every document that has all the words, those with a fitting title first."""
    needles = wanted.lower().split()
    hits = [
        (document, section)
        for document in TITLES
        for section in sections(document)
        if all(needle in section.words for needle in needles)
    ]
    return sorted(hits, key=lambda hit: not all(needle in hit[1].title.lower() for needle in needles))


def slug(title: str) -> str:
    """Return the anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _parts(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of each section: a heading of level 1 to 3 and what stands below it."""
    part: list[Token] = []
    for token in tokens:
        if token.type == "heading_open" and token.tag in ("h1", "h2", "h3") and part:
            yield part
            part = []
        part.append(token)
    if part:
        yield part


def _section(parser: MarkdownIt, part: list[Token]) -> GuideSection:
    heading = part[1] if part[0].type == "heading_open" else None
    title = _plain(heading) if heading else ""
    body = part[3:] if heading else part
    level = int(part[0].tag[1]) if heading else 1
    html = Markup(parser.renderer.render(body, parser.options, {}))  # noqa: S704 - our own documents
    words = " ".join(token.content for token in part if token.type in ("inline", "fence"))
    return GuideSection(slug(title), level, title, html, words.lower())


def _plain(token: Token) -> str:
    return "".join(child.content for child in token.children or ())


class _Pages(RendererHTML):
    """Renders documents so that their links and pictures lead to pages of the panel, and no HTML comes in."""

    def html_inline(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return anchors as they are and everything else as text."""
        text = tokens[at].content
        return text if ANCHOR.fullmatch(text) else str(escape(text))

    def html_block(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return HTML as text."""
        return str(escape(tokens[at].content))

    def link_open(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return the way to a document as the way to its page; what the panel has not is no link."""
        target = here(str(tokens[at].attrs.get("href", "")))
        return f'<a href="{escape(target)}">' if target else '<a class="elsewhere">'

    def table_open(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return a table that may be wider than the page."""
        return '<div class="table-wide" tabindex="0" role="group" aria-label="Table"><table class="table">'

    def table_close(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return the end of a table."""
        return "</table></div>"

    def fence(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return code that may be wider than the page."""
        code = escape(tokens[at].content)
        return f'<pre tabindex="0" role="group" aria-label="Commands"><code>{code}</code></pre>'

    def image(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return a picture, loaded when it comes into view."""
        source = str(tokens[at].attrs.get("src", ""))
        words = escape(tokens[at].content)
        match = PICTURE.fullmatch(source)
        if match is None:
            return str(words)
        return f'<img src="/guide/pictures/{match[1]}" loading="lazy" alt="{words}">'


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
