"""Photos as they come from a camera, made small, plain and free of what they tell besides the picture."""

from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING

from app.base.message import N_
from app.base.startup import late

if TYPE_CHECKING:
    from PIL.Image import Image

LONGEST_EDGE = 1600
MOST_PIXELS = 60_000_000
LARGEST_UPLOAD = 8 * 1024 * 1024
QUALITY = 82
FORMATS = ("JPEG", "PNG")


class PhotoRefused(ValueError):
    """A file is no photo that can be kept; the text says what to do."""


@dataclass(frozen=True, slots=True)
class PlainPhoto:
    """A JPEG without metadata, and its pixels."""

    content: bytes
    width: int
    height: int


def plain_photo(upload: bytes) -> PlainPhoto:
    """Return an upload as an upright JPEG of at most 1600 pixels a side, or raise `PhotoRefused`."""
    if len(upload) > LARGEST_UPLOAD:
        raise PhotoRefused(N_("A photo can have at most 8 MB: take the photo at a lower resolution."))
    pictures = late("PIL.Image")
    try:
        with pictures.open(BytesIO(upload), formats=FORMATS) as opened:
            return _plain(opened)
    except (OSError, SyntaxError, ValueError, pictures.DecompressionBombError) as error:
        if isinstance(error, PhotoRefused):
            raise
        raise PhotoRefused(
            N_("This file is not a JPEG or PNG image, or it is damaged: choose another file.")
        ) from None


def _plain(opened: "Image") -> PlainPhoto:
    if opened.width * opened.height > MOST_PIXELS:
        raise PhotoRefused(
            N_("A photo can have at most 60 million pixels: take the photo at a lower resolution.")
        )
    opened.draft("RGB", (LONGEST_EDGE, LONGEST_EDGE))
    upright = late("PIL.ImageOps").exif_transpose(opened).convert("RGBA")
    upright.thumbnail((LONGEST_EDGE, LONGEST_EDGE))
    # A new picture has none of the old one's metadata.
    paper = late("PIL.Image").new("RGB", upright.size, "white")
    paper.paste(upright, mask=upright)
    out = BytesIO()
    paper.save(out, "JPEG", quality=QUALITY, optimize=True)
    return PlainPhoto(out.getvalue(), paper.width, paper.height)
