"""Pages without the line breaks and indents of their templates."""

import re
from collections.abc import Iterable, Iterator

from jinja2.ext import Extension
from jinja2.lexer import Token, TokenStream

SPACES = re.compile(r"\s+")


class OneSpace(Extension):
    """Writes one space where a template has several or a new line: to a browser these are the same.

    A template can be laid out for its readers, and a page weighs what it says. Values stay as they are, such
    as the text in a `textarea`.
    """

    def filter_stream(self, stream: TokenStream) -> Iterable[Token]:
        """Return the tokens of a template, with single spaces in what it writes as it stands."""
        return _with_one_space(stream)


def _with_one_space(stream: TokenStream) -> Iterator[Token]:
    for token in stream:
        if token.type == "data":
            yield Token(token.lineno, token.type, SPACES.sub(" ", token.value))
        else:
            yield token
