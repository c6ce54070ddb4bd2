"""What stands on the pages of a PDF, read as a viewer that copies its text reads it."""

import re
import zlib
from collections.abc import Iterator

SHOWN = re.compile(rb"\(((?:\\.|[^\\)])*)\)\s*Tj", re.DOTALL)
ESCAPES = {b"\\n": b"\n", b"\\r": b"\r", b"\\t": b"\t"}


def words_of(pdf: bytes) -> str:
    """Return every line as each of the PDF's fonts reads it, one font after the other."""
    streams = list(_streams(pdf))
    drawn = [_plain(found[1]) for one in streams for found in SHOWN.finditer(one)]
    fonts = [_letters(one) for one in streams if b"beginbfchar" in one]
    assert fonts, "the PDF tells no viewer which letters it shows"
    read = (
        "".join(font.get(line[at : at + 2], "?") for at in range(0, len(line), 2))
        for font in fonts
        for line in drawn
    )
    return " ".join(" ".join(read).split())


def _streams(pdf: bytes) -> Iterator[bytes]:
    for found in re.finditer(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        try:
            yield zlib.decompress(found[1])
        except zlib.error:
            yield found[1]


def _plain(text: bytes) -> bytes:
    return re.sub(rb"\\.", lambda found: ESCAPES.get(found[0], found[0][1:]), text, flags=re.DOTALL)


def _letters(cmap: bytes) -> dict[bytes, str]:
    pairs = re.findall(rb"<([0-9A-Fa-f]{4})> <([0-9A-Fa-f]+)>", cmap)
    return {
        bytes.fromhex(code.decode()): bytes.fromhex(text.decode()).decode("utf-16-be") for code, text in pairs
    }
