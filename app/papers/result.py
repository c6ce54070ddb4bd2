"""What is told of a paper: published figures beside ours, errata with their effect, gaps."""

from dataclasses import dataclass
from enum import StrEnum


class Standing(StrEnum):
    """How a published figure fares."""

    AGREES = "agrees"
    DIFFERS = "differs"
    MEASURED = "measured"


@dataclass(frozen=True, slots=True)
class Figure:
    """A published value and ours, in `unit`; it agrees within `within`. Without the former it is measured.

    `remark` says why it differs, or how ours was had.
    """

    name: str
    unit: str
    published: float | None
    ours: float
    within: float = 0.0
    digits: int = 2
    remark: str = ""

    @property
    def difference(self) -> float | None:
        """Return ours less the published value, None where none is published."""
        return None if self.published is None else self.ours - self.published

    @property
    def standing(self) -> Standing:
        """Return whether ours is the published value."""
        if self.difference is None:
            return Standing.MEASURED
        return Standing.AGREES if abs(self.difference) <= self.within else Standing.DIFFERS


@dataclass(frozen=True, slots=True)
class Group:
    """A table or figure of a paper; `note` says how ours was computed."""

    title: str
    note: str
    figures: tuple[Figure, ...]

    @property
    def agreeing(self) -> int:
        """Return how many published figures come out."""
        return sum(figure.standing is Standing.AGREES for figure in self.figures)

    @property
    def published(self) -> int:
        """Return how many figures are published."""
        return sum(figure.published is not None for figure in self.figures)


@dataclass(frozen=True, slots=True)
class Erratum:
    """A misprint: where, what is printed, what it must be, and what was measured to follow from it."""

    where: str
    printed: str
    right: str
    effect: str


@dataclass(frozen=True, slots=True)
class Gap:
    """What a paper tells that cannot be computed, and why not."""

    what: str
    why: str


@dataclass(frozen=True, slots=True)
class Paper:
    """One of the five papers."""

    key: str
    name: str
    citation: str
    groups: tuple[Group, ...]
    errata: tuple[Erratum, ...]
    gaps: tuple[Gap, ...]

    @property
    def agreeing(self) -> int:
        """Return how many published figures come out."""
        return sum(group.agreeing for group in self.groups)

    @property
    def published(self) -> int:
        """Return how many figures are published."""
        return sum(group.published for group in self.groups)

    @property
    def summary(self) -> str:
        """Return in a sentence how many of the published figures come out, and how many errata there are."""
        errata = f"{len(self.errata)} errata, with the measured effect of each."
        if self.published == 1:
            comes_out = "comes out" if self.agreeing else "differs"
            return f"The one published figure that can be computed {comes_out}. {errata}"
        return f"{self.agreeing} of {self.published} published figures come out. {errata}"
