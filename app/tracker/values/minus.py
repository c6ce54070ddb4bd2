"""The minus sign as keyboards, phones, and word processors write it."""

DASHES = (
    "\N{HYPHEN}\N{NON-BREAKING HYPHEN}\N{FIGURE DASH}\N{EN DASH}\N{MINUS SIGN}"
    "\N{SMALL HYPHEN-MINUS}\N{FULLWIDTH HYPHEN-MINUS}"
)
"""An em dash is none of them: word processors make it of two hyphens."""

_TO_MINUS = str.maketrans(dict.fromkeys(DASHES, "-"))


def with_minus(text: str) -> str:
    """Return a typed number with the minus sign that programs read."""
    return text.translate(_TO_MINUS)
