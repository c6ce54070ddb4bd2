"""Signatures drawn on a screen: read and bounded, and drawn again as lines on any paper."""

import json
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise
from typing import Any

from app.base.message import N_, Message, say
from app.base.names import tidy, unseen
from app.store.documents import plain

WIDTH, HEIGHT = 1000, 300
"""The field that a signature is drawn in; its points are whole numbers within it, y downwards."""

MOST_STROKES = 200
MOST_POINTS = 6000
LONGEST_NAME = 80

Stroke = tuple[tuple[int, int], ...]


class SignatureRole(StrEnum):
    """For whom somebody signs."""

    TECHNICIAN = "technician"
    CUSTOMER = "customer"


ROLE_WORDS = {
    SignatureRole.TECHNICIAN: N_("Commissioned by"),
    SignatureRole.CUSTOMER: N_("Accepted by"),
}


class SignatureRefused(ValueError):
    """What was drawn or typed is no signature; the text says what to do."""


@dataclass(frozen=True, slots=True)
class Signature:
    """A typed name and what was drawn beside it; without strokes it is signed on paper."""

    role: SignatureRole
    name: str
    strokes: tuple[Stroke, ...] = ()

    @property
    def words(self) -> Message:
        """Return for whom this is signed."""
        return ROLE_WORDS[self.role]

    @property
    def path(self) -> str:
        """Return the strokes as SVG path data in a field of WIDTH x HEIGHT."""
        return " ".join("M" + " L".join(f"{x} {y}" for x, y in stroke) for stroke in self.strokes)

    @property
    def lines(self) -> list[tuple[tuple[int, int], tuple[int, int]]]:
        """Return every straight piece of the strokes, from point to point."""
        return [piece for stroke in self.strokes for piece in pairwise(stroke)]


def signature(role: SignatureRole, name: str, drawn: str) -> Signature | None:
    """Return what was signed, None where nothing was, or raise `SignatureRefused`."""
    name = plain(tidy(" ".join(name.split())))
    strokes = _strokes(drawn)
    if not name and not strokes:
        return None
    if not name:
        raise SignatureRefused(
            say("{role_words}: type the name of the person who signed.", role_words=ROLE_WORDS[role])
        )
    if fault := unseen(name):
        raise SignatureRefused(fault)
    if len(name) > LONGEST_NAME:
        raise SignatureRefused(
            say(
                "{role_words}: a name can have at most {longest_name} characters.",
                role_words=ROLE_WORDS[role],
                longest_name=LONGEST_NAME,
            )
        )
    return Signature(role, name, strokes)


def _strokes(drawn: str) -> tuple[Stroke, ...]:
    try:
        found = json.loads(drawn or "[]")
        strokes = tuple(tuple(_point(point) for point in stroke) for stroke in found)
    except (ValueError, TypeError, RecursionError):
        raise SignatureRefused(
            N_("The drawn signature cannot be read: clear the field and sign again.")
        ) from None
    if len(strokes) > MOST_STROKES or sum(map(len, strokes)) > MOST_POINTS:
        raise SignatureRefused(N_("The drawn signature has too many lines: clear the field and sign again."))
    return tuple(stroke for stroke in strokes if len(stroke) > 1)


def _point(point: Any) -> tuple[int, int]:
    x, y = (int(value) for value in point)
    if not (0 <= x <= WIDTH and 0 <= y <= HEIGHT):
        raise ValueError
    return x, y
