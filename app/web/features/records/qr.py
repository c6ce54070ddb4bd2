"""QR codes as SVG path data."""

from app.base.startup import late

QUIET = 4
"""Empty modules around a code, as ISO/IEC 18004 wants them."""


def qr_path(text: str) -> tuple[str, int]:
    """Return the dark modules of a QR code as path data on a grid, and how many units the grid is wide."""
    matrix = late("segno").make(text, error="m", micro=False).matrix
    rows = (
        f"M{x + QUIET} {y + QUIET}h1v1h-1z"
        for y, row in enumerate(matrix)
        for x, dark in enumerate(row)
        if dark
    )
    return "".join(rows), len(matrix) + 2 * QUIET
