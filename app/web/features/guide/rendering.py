"""Markdown rendered on the server: a document in sections, with anchors, links and pictures of the panel."""

import re
from collections.abc import Iterator, Sequence

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.rules_core import StateCore
from markdown_it.token import Token
from markdown_it.utils import EnvType, OptionsDict
from markupsafe import Markup, escape

from app.base.message import N_
from app.web.features.guide.guide import PICTURE, GuideSection, folded, here, slug, text_of
from app.web.languages import IN_ENGLISH
from app.web.languages.catalogue import Catalogue

TABLE, COMMANDS = N_("Table"), N_("Commands")
ANCHOR = re.compile(r'<a id="[\w.-]+">|</a>')
WORD = re.compile("[A-Za-z]{2}")


def sections_of(text: str, catalogue: Catalogue) -> tuple[GuideSection, ...]:
    """Return the sections of a document's Markdown in the language of a catalogue."""
    parser, told = _parser(), {"catalogue": catalogue}
    return tuple(_section(parser, part, told) for part in _parts(parser.parse(text, told)))


def rendered(text: str) -> str:
    """Return Markdown as HTML."""
    return str(_parser().render(text, {"catalogue": IN_ENGLISH}))


def blocks(document: str) -> Iterator[tuple[int, str]]:
    """Return line and Markdown of every heading, paragraph, list item and cell that has words."""
    for token in _parser().disable("inline").parse(text_of(document), {"catalogue": IN_ENGLISH}):
        if token.type == "inline" and WORD.search(token.content):
            yield token.map[0] + 1 if token.map else 0, token.content


def _parser() -> MarkdownIt:
    parser = MarkdownIt("commonmark", renderer_cls=_Pages).enable("table")
    parser.core.ruler.before("inline", "translation", _translate)
    return parser


def _translate(state: StateCore) -> None:
    """Say every block in the reader's language before the Markdown in it is read."""
    catalogue: Catalogue = state.env["catalogue"]
    for token in state.tokens:
        if token.type == "inline":
            token.meta["english"] = token.content
            token.content = catalogue.block(token.content)


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


def _section(parser: MarkdownIt, part: list[Token], told: EnvType) -> GuideSection:
    heading = part[1] if part[0].type == "heading_open" else None
    anchor, title = (slug(heading.meta["english"]), _plain(heading)) if heading else ("", "")
    body = part[3:] if heading else part
    level = int(part[0].tag[1]) if heading else 1
    html = Markup(parser.renderer.render(body, parser.options, told))  # noqa: S704 - our own documents
    return GuideSection(anchor, level, title, html, folded(" ".join(_words(part))))


def _words(part: list[Token]) -> Iterator[str]:
    """Return what a section can be found by: what it says, and the English of that."""
    for token in part:
        if token.type in ("inline", "fence"):
            yield token.content
            if token.meta.get("english", token.content) != token.content:
                yield token.meta["english"]


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
        label = escape(env["catalogue"].gettext(TABLE))
        return f'<div class="table-wide" tabindex="0" role="group" aria-label="{label}"><table class="table">'

    def table_close(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return the end of a table."""
        return "</table></div>"

    def th_open(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return a heading of a column; which columns are numbers is said by a class, not by a style."""
        return _cell(tokens[at])

    def td_open(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return a cell as the heading of its column."""
        return _cell(tokens[at])

    def fence(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return code that may be wider than the page."""
        code, label = escape(tokens[at].content), escape(env["catalogue"].gettext(COMMANDS))
        return f'<pre tabindex="0" role="group" aria-label="{label}" lang="en"><code>{code}</code></pre>'

    def image(self, tokens: Sequence[Token], at: int, options: OptionsDict, env: EnvType) -> str:
        """Return a picture, loaded when it comes into view."""
        source = str(tokens[at].attrs.get("src", ""))
        words = escape(tokens[at].content)
        match = PICTURE.fullmatch(source)
        if match is None:
            return str(words)
        return f'<img src="/guide/pictures/{match[1]}" loading="lazy" alt="{words}">'


def _cell(token: Token) -> str:
    aligned = "right" in str(token.attrs.get("style", ""))
    return f'<{token.tag} class="number">' if aligned else f"<{token.tag}>"
