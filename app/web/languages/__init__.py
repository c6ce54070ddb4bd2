"""The language of a page: which catalogue serves this request, and what a sentence is called in it."""

from contextvars import ContextVar

from app.web.languages.catalogue import Catalogue, catalogue_of
from app.web.languages.known import ENGLISH, Language

IN_ENGLISH = catalogue_of(ENGLISH.code)
CATALOGUE: ContextVar[Catalogue] = ContextVar("catalogue", default=IN_ENGLISH)
"""The catalogue of the request that is being answered."""


def spoken() -> Language:
    """Return the language of the request."""
    return CATALOGUE.get().language


def gettext(message: str) -> str:
    """Return a text of a template in the language of the request."""
    return CATALOGUE.get().gettext(message)


def ngettext(one: str, many: str, count: int) -> str:
    """Return a text of a template for a number of things in the language of the request."""
    return CATALOGUE.get().ngettext(one, many, count)


def pgettext(where: str, message: str) -> str:
    """Return a text whose meaning depends on where it stands in the language of the request."""
    return CATALOGUE.get().pgettext(where, message)


def npgettext(where: str, one: str, many: str, count: int) -> str:
    """Return a text for a number of things whose meaning depends on where it stands."""
    return CATALOGUE.get().npgettext(where, one, many, count)


def said(sentence: str) -> str:
    """Return what the program says in English (a label, a reason) in the language of the request."""
    return CATALOGUE.get().said(sentence) if sentence else ""
