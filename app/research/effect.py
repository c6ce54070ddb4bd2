"""What follows from a misprint, in words and numbers; no number of it can be typed."""

from dataclasses import dataclass
from math import floor, log10


@dataclass(frozen=True, slots=True)
class Measured:
    """A number that was computed, and how many of its figures are told."""

    value: float
    count: int


@dataclass(frozen=True, slots=True)
class Effect:
    """Words and computed numbers by turns; without a number the effect is not measured.

    Raises `ValueError` for a digit in the words.
    """

    parts: tuple[str | Measured, ...]

    def __post_init__(self) -> None:
        """Refuse a number that was typed."""
        if any(isinstance(part, str) and any(map(str.isdigit, part)) for part in self.parts):
            raise ValueError("A number in an effect is measured, not typed.")

    @property
    def measured(self) -> bool:
        """Return whether there is a computed number in it."""
        return any(isinstance(part, Measured) for part in self.parts)

    @property
    def text(self) -> str:
        """Return the effect as it is shown."""
        return "".join(
            figures(part.value, part.count) if isinstance(part, Measured) else part for part in self.parts
        )


def effect(*parts: str | Measured) -> Effect:
    """Return an effect of its parts in order."""
    return Effect(parts)


def not_measured(why: str) -> Effect:
    """Return the effect of a misprint that leaves nothing to compute."""
    return Effect((f"not measured: {why}",))


def figures(value: float, count: int) -> str:
    """Return a number with at least so many significant figures, never as a power of ten."""
    before = floor(log10(abs(value))) + 1 if value else count
    return f"{value:.{max(0, count - before)}f}"
