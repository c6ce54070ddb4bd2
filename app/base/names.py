"""Names and short texts that people type: one spelling of each, and nothing in them that is not seen."""

import re
from unicodedata import category, normalize

from app.base.message import Message, say

LONGEST_TYPED = 300
"""How long a name may be as it is typed, before it is tidy."""
LONGEST_COMPOSED = 5000
"""Composing takes time by the square of a text's marks; a longer text is too long for every field anyway."""
SOFT_HYPHEN = "\N{SOFT HYPHEN}"
JOINERS = "\N{ZERO WIDTH NON-JOINER}\N{ZERO WIDTH JOINER}"
"""Persian and Indian scripts and emoji need them between letters."""
BLANK_LETTERS = (
    "\N{HANGUL CHOSEONG FILLER}\N{HANGUL JUNGSEONG FILLER}\N{HANGUL FILLER}\N{HALFWIDTH HANGUL FILLER}"
    "\N{BRAILLE PATTERN BLANK}"
)
UNSEEN = ("Cc", "Cf", "Co", "Cs", "Zl", "Zp")
JOINED = rf"[^\x00-\x7f\s{JOINERS}]"
REPEATED = re.compile(rf"([{JOINERS}])[{JOINERS}]+")
IDLE = re.compile(rf"(?<!{JOINED})[{JOINERS}]|[{JOINERS}](?!{JOINED})")


def tidy(text: str) -> str:
    """Return a text as it is stored: composed, with plain spaces, without soft hyphens and idle joiners.

    One that is too long to be stored anywhere is returned as it is.
    """
    if len(text) > LONGEST_COMPOSED:
        return text
    spaced = "".join(" " if category(letter) == "Zs" else letter for letter in text)
    composed = normalize("NFC", spaced.replace(SOFT_HYPHEN, ""))
    return IDLE.sub("", REPEATED.sub(r"\1", composed)).strip()


def unseen(text: str) -> Message | None:
    """Return a sentence about the first character of a tidy text that is not visible, None without one."""
    for letter in text:
        if _is_unseen(letter):
            return say(
                "The text contains an invisible character ({code}). Type it again instead of pasting it.",
                code=f"U+{ord(letter):04X}",
            )
    return None


def clean(text: str, *, lines: bool = False) -> str:
    """Return a text as it is stored, or raise `ValueError`; with `lines` it may have several."""
    found = "\n".join(map(tidy, text.splitlines())).strip() if lines else tidy(text)
    if fault := unseen(found.replace("\n", " ") if lines else found):
        raise ValueError(fault)
    return found


def _is_unseen(letter: str) -> bool:
    is_no_character = ord(letter) & 0xFFFE == 0xFFFE
    return (
        is_no_character or letter in BLANK_LETTERS or (category(letter) in UNSEEN and letter not in JOINERS)
    )
