"""What is told of a paper: published figures beside ours, errata with their effect, gaps."""

from dataclasses import dataclass
from enum import StrEnum

from app.research.effect import Effect


class Standing(StrEnum):
    """How a published figure fares."""

    AGREES = "agrees"
    DIFFERS = "differs"
    MEASURED = "measured"


class Basis(StrEnum):
    """What ours is had from: computed, fitted so that it must come out, or other numbers that are printed."""

    COMPUTED = "computed"
    FITTED = "fitted"
    PRINTED = "printed"


@dataclass(frozen=True, slots=True)
class Figure:
    """A published value and ours, in `unit`; it agrees within `within`. Without the former it is measured.

    `remark` says why it differs, or how ours was had; `basis` whether it proves anything that it comes out.
    """

    name: str
    unit: str
    published: float | None
    ours: float
    within: float = 0.0
    digits: int = 2
    remark: str = ""
    basis: Basis = Basis.COMPUTED

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
    """A misprint: where, what is printed, what it must be, and what follows from it."""

    where: str
    printed: str
    right: str
    effect: Effect


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
        """Return in sentences how many of the published figures come out, and how many errata there are."""
        measured = sum(one.effect.measured for one in self.errata)
        errata = f"{len(self.errata)} errata; the effect of {measured} is measured."
        if self.published == 1:
            comes_out = "comes out" if self.agreeing else "differs"
            return f"The one published figure that can be computed {comes_out}. {errata}"
        return f"{self.agreeing} of {self.published} published figures come out.{self._proving_less} {errata}"

    @property
    def _proving_less(self) -> str:
        """Return how many of those that come out are fitted, or compare the paper with itself."""
        agreeing = [
            figure.basis
            for group in self.groups
            for figure in group.figures
            if figure.standing is Standing.AGREES
        ]
        fitted, printed = agreeing.count(Basis.FITTED), agreeing.count(Basis.PRINTED)
        if not fitted + printed:
            return ""
        return f" Of these {fitted} are fitted, and {printed} compare the paper with its own other numbers."
