"""Reads the one place that a link to a map names; links are read as text and never opened."""

import re
from urllib.parse import unquote_plus, urlsplit

NUMBER = r"([+-]?\d{1,3}(?:\.\d+)?)"
BOTH = rf"{NUMBER},\s*{NUMBER}"
END = r"(?=[/?&#(]|$)"
LINK = re.compile(r"geo:|\w+://|(?:[\w-]+\.)+[a-z]{2,}(?:[/?#]|$)", re.IGNORECASE)
GEO = re.compile(rf"geo:{BOTH}(?:,[+-]?\d+(?:\.\d+)?)?((?:;[\w-]+(?:=[\w.%-]*)?)*)(\?.*)?", re.IGNORECASE)
QUERY = re.compile(rf"[?&]q={BOTH}{END}")
MAPS = {
    r"(?:www\.|maps\.)?google(?:\.[a-z]{2,3}){1,2}": (
        (
            r"!3d" + NUMBER + r"!4d" + NUMBER,
            rf"[?&](?:q|query|ll)=(?:loc:)?{BOTH}{END}",
            rf"/(?:place|search)/{BOTH}{END}",
        ),
        (rf"/@{BOTH}(?=,)", rf"[?&]center={BOTH}{END}"),
    ),
    r"(?:www\.)?(?:openstreetmap|osm)\.org": (
        (rf"[?&]mlat={NUMBER}&mlon={NUMBER}{END}",),
        (rf"#(?:.*&)?map=\d+(?:\.\d+)?/{NUMBER}/{NUMBER}{END}",),
    ),
    r"maps\.apple\.com": (
        (rf"[?&](?:ll|coordinate|q)={BOTH}{END}",),
        (rf"[?&]center={BOTH}{END}",),
    ),
}
"""By host: how a link marks a place and, where it marks none, the center of its map."""
WORLD = "wgs84"

Place = tuple[float, float]


def is_link(text: str) -> bool:
    """Return whether a text is, or has in it, a link."""
    return bool(LINK.match(text)) or "://" in text


def linked(text: str) -> Place | None:
    """Return the latitude and longitude that a link names, None where it names none or several."""
    try:
        text = unquote_plus(text)
        host = urlsplit(text if "://" in text else f"//{text}").hostname or ""
    except ValueError:
        return None
    if match := GEO.fullmatch(text):
        return _geo(match)
    if "/dir/" in text:
        return None
    for known, (marked, centered) in MAPS.items():
        if re.fullmatch(known, host, re.IGNORECASE):
            return _only(_found(marked, text) or _found(centered, text))
    return None


def _geo(match: re.Match[str]) -> Place | None:
    """Return the place of an RFC 5870 link; Android's phones write 0,0 and the place as a question."""
    latitude, longitude, parameters, question = match.groups()
    names = dict(part.lower().partition("=")[::2] for part in parameters.split(";")[1:])
    if names.get("crs", WORLD) != WORLD:
        return None
    place = (float(latitude), float(longitude))
    asked = _found((QUERY.pattern,), question or "")
    if place == (0.0, 0.0) and question:
        return _only(asked)
    return _only(asked | {place})


def _found(patterns: tuple[str, ...], text: str) -> set[Place]:
    return {
        (float(latitude), float(longitude))
        for pattern in patterns
        for latitude, longitude in re.findall(pattern, text)
    }


def _only(places: set[Place]) -> Place | None:
    return places.pop() if len(places) == 1 else None
