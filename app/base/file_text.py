"""The text of files that people write or download, whatever program saved them.

UTF-8 with or without a byte order mark, UTF-16 with one; every line ends in a line feed. What has no mark
and is not UTF-8 is in one of many single-byte encodings, which differ in the letters beyond ASCII, never in
digits, points, commas, and names of columns. So it is taken only by a reader that needs nothing else of a
file, such as that of weather files, whose city and comments are not used: `letters_count=False`. Where names
are kept, a guess would change them, so the file is refused.

No detector of encodings: charset-normalizer comes only with the extra `studies`, and it guesses.
"""

import codecs
import re
import tomllib
from typing import Any

from app.base.message import N_

NOT_UTF8 = N_("The file is not UTF-8 text. Save it as UTF-8, then use it again.")
NO_TEXT = N_("The file is not text. Choose the file that another program exported as text.")
LINE_END = re.compile("\r\n?")
UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


class TextRefused(ValueError):
    """The bytes are no text that can be read without a guess; the sentence says what to do."""


def text_of(content: bytes, *, letters_count: bool = True) -> str:
    """Return the text of a file with lines that end in a line feed, or raise `TextRefused`."""
    if content.startswith(UTF16):
        text = _decoded(content, "utf-16")
    else:
        try:
            text = _decoded(content, "utf-8-sig")
        except TextRefused:
            if letters_count or b"\0" in content:
                raise
            text = content.decode("latin-1")
    if "\0" in text:
        raise TextRefused(NO_TEXT)
    return LINE_END.sub("\n", text)


def toml_of(content: bytes) -> dict[str, Any]:
    """Return what a TOML file says; a byte order mark, as Notepad writes it, is none of it.

    Raises `TextRefused` for what is not UTF-8, which TOML prescribes, and `tomllib.TOMLDecodeError`.
    """
    return tomllib.loads(utf8_of(content))


def utf8_of(content: bytes) -> str:
    """Return the text of a file whose format prescribes UTF-8, or raise `TextRefused`."""
    if content.startswith(UTF16) or b"\0" in content:
        raise TextRefused(NOT_UTF8)
    return text_of(content)


def _decoded(content: bytes, encoding: str) -> str:
    try:
        return content.decode(encoding)
    except UnicodeDecodeError as error:
        raise TextRefused(NOT_UTF8) from error
