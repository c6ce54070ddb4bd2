"""Catalogues of a few texts, made in memory."""

from io import BytesIO

from babel.messages.catalog import Catalog

from app.web.languages.catalogue import Catalogue
from app.web.languages.known import LANGUAGES
from app.web.translation.catalogues import mo_bytes

GERMAN = {
    "The wind at {name} is too strong: {good} m/s.": "Der Wind bei {name} ist zu stark: {good} m/s.",
    "Stopped by a fault: {message}": "Durch eine Störung angehalten: {message}",
    "The drive of {name} does not answer.": "Der Antrieb von {name} antwortet nicht.",
    "The {axis} axis is measured.": "Die Achse {axis} wird gemessen.",
    "The {axis} axis of {name}": "{name}, Achse {axis}",
    "{meaning} {least} to {most}, usual {default}.": "{meaning} {least} bis {most}, üblich {default}.",
    "Time to stand.": "Zeit zu stehen.",
    "{low} to {high}": "{low} bis {high}",
    "is busy with a show": "ist mit einer Vorführung beschäftigt",
    "Nothing moves. Nothing is recorded.": "Nichts bewegt sich. Nichts wird aufgezeichnet.",
    "Azimuth": "Azimut",
    "Elevation": "Höhe",
    "Holding": "Steht",
}


def catalogue(texts: dict[str, str] = GERMAN, code: str = "de") -> Catalogue:
    """Return a catalogue of these texts, German unless told otherwise."""
    catalog = Catalog(locale=code, charset="utf-8")
    for one, wanted in texts.items():
        catalog.add(one, wanted)
    return Catalogue(LANGUAGES[code], BytesIO(mo_bytes(catalog)))
