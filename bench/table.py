"""One row of the benchmark report."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Row:
    """What was measured, ours, the peer or bound of the same run, their ratio, and the command."""

    name: str
    ours: str
    peer: str
    ratio: str
    command: str
