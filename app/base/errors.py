"""What was foreseen to go wrong."""

from typing import ClassVar

AT_RUN_TIME = 1
WRONG = 2
"""Exit codes: something failed that may work later; what was asked or set is wrong, so no new start helps."""


class Foreseen(Exception):
    """Something that cannot be done; the text is a sentence for whoever asked."""

    exit_code: ClassVar[int] = AT_RUN_TIME
