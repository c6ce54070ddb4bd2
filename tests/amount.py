"""How much of a proof is run: a cut of it in `make test`, all of it in `make soak`."""

import os
from typing import TypeVar

T = TypeVar("T")

SOAK = os.environ.get("HELIOPANEL_SOAK") == "1"


def amount(cut: T, whole: T) -> T:
    """Return how much is run here: the whole under `make soak`, else the cut."""
    return whole if SOAK else cut
