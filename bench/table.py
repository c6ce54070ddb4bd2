"""One row of the benchmark report, and why there is none."""

from dataclasses import dataclass


class NotMeasured(Exception):
    """What a benchmark needs is not there; says what."""


@dataclass(frozen=True, slots=True)
class Row:
    """What was measured, ours, the peer or bound of the same run, their ratio, and the command."""

    name: str
    ours: str
    peer: str
    ratio: str
    command: str
