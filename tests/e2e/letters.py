"""The letters that a browser of the tests finds on the computer: none, so no test depends on what there is.

Chromium ends at once where there is no font at all. `no_letters` therefore holds one without a single letter:
whatever our own letters do not draw becomes a black box, as wide as it is high. It was made with

    from fontTools.fontBuilder import FontBuilder
    from fontTools.pens.ttGlyphPen import TTGlyphPen

    pen = TTGlyphPen(None)
    pen.moveTo((50, 0)), pen.lineTo((50, 900)), pen.lineTo((950, 900)), pen.lineTo((950, 0)), pen.closePath()
    font = FontBuilder(1000, isTTF=True)
    font.setupGlyphOrder([".notdef"]), font.setupCharacterMap({}), font.setupGlyf({".notdef": pen.glyph()})
    font.setupHorizontalMetrics({".notdef": (1000, 50)}), font.setupHorizontalHeader(ascent=900, descent=-100)
    font.setupNameTable({"familyName": "No letters", "styleName": "Regular"})
    font.setupOS2(sTypoAscender=900, sTypoDescender=-100, usWinAscent=900, usWinDescent=100), font.setupPost()
    font.save("none.ttf")
"""

import os
from pathlib import Path

NO_LETTERS = Path(__file__).parent / "no_letters" / "fonts.conf"


def environment(fonts: Path = NO_LETTERS) -> dict[str, str]:
    """Return the environment of a browser that finds these fonts and no others."""
    return os.environ | {"FONTCONFIG_FILE": str(fonts)}
