"""One row of the benchmark report, and why there is none.

Every comparison has one direction: how many times better ours is than the bound or the peer beside it. From 1
on is good; below it a row says in words that its bound is missed, or that it is behind its peer.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, inf

ENOUGH_FOR_P999 = 1000
"""With fewer values the 99.9th percentile is the greatest of them, and is called so."""


class NotMeasured(Exception):
    """What a benchmark needs is not there; says what."""


@dataclass(frozen=True, slots=True)
class Row:
    """What was measured, ours, the bound or the peer of the same run, what came of it, and the command."""

    name: str
    ours: str
    against: str
    verdict: str
    command: str


def at_most(name: str, value: float, bound: float, unit: str, command: str, *, ours: str = "") -> Row:
    """Return a row of what must not be greater than its bound; `ours` says more than the value."""
    return _bound(
        name, ours or _told(value, unit), f"at most {_told(bound, unit)}", _ratio(bound, value), command
    )


def at_least(name: str, value: float, bound: float, unit: str, command: str, *, ours: str = "") -> Row:
    """Return a row of what must not be less than its bound."""
    return _bound(
        name, ours or _told(value, unit), f"at least {_told(bound, unit)}", _ratio(value, bound), command
    )


def must_hold(name: str, ours: str, wanted: str, command: str, *, holds: bool) -> Row:
    """Return a row of what holds or does not: something lost, something that must not happen."""
    return Row(name, ours, wanted, "met" if holds else "**missed**", command)


def beside(name: str, ours: str, peer: str, better: float, command: str) -> Row:
    """Return a row beside a peer of the same run, `better` times as good as that."""
    return Row(
        name, ours, peer, _times(better) if better >= 1.0 else f"**behind**, {_times(better)}", command
    )


def alone(name: str, ours: str, command: str) -> Row:
    """Return a row that is compared with nothing."""
    return Row(name, ours, "", "", command)


def spread(values: Sequence[float], unit: str = "ms") -> str:
    """Return median, 99th percentile and, of a thousand values or more, the 99.9th, and the maximum."""
    told = [f"p50 {percentile(values, 0.5):.3g}", f"p99 {percentile(values, 0.99):.3g}"]
    if len(values) >= ENOUGH_FOR_P999:
        told.append(f"p99.9 {percentile(values, 0.999):.3g}")
    return ", ".join((*told, f"max {max(values):.3g} {unit}"))


def worst(values: Sequence[float]) -> tuple[str, float]:
    """Return the name and the value of the last percentile that so many values can tell."""
    if len(values) >= ENOUGH_FOR_P999:
        return "p99.9", percentile(values, 0.999)
    return "maximum", max(values)


def percentile(values: Sequence[float], share: float) -> float:
    """Return the least value that so great a share of them does not exceed."""
    return sorted(values)[max(0, ceil(len(values) * share) - 1)]


def _bound(name: str, ours: str, bound: str, better: float, command: str) -> Row:
    return Row(
        name, ours, bound, _times(better) if better >= 1.0 else f"**missed**, {_times(better)}", command
    )


def _ratio(above: float, below: float) -> float:
    return above / below if below else inf


def _times(better: float) -> str:
    if better == inf:
        return "any number of times"
    return f"{better:,.0f}" if better >= 100.0 else f"{better:.3g}"


def _told(value: float, unit: str) -> str:
    return f"{value:,.0f} {unit}" if value >= 100.0 else f"{value:.3g} {unit}"
