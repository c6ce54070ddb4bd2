"""What a test says of the row of the fault table that it proves: `docs/reference/faults.md` is made of it."""

from collections.abc import Callable

VIRTUAL, REAL = "virtual clock", "real clock"
RESET = "the operator resets the fault"
HOME_AGAIN = "the home position is set again"
BY_ITSELF = "automatic"
Record = Callable[[str, object], None]


class FaultResult:
    """Takes the measured time, the sentence that was shown and the recovery that was seen.

    Each is handed over after the test has asserted it. The page of faults has no other source.
    """

    def __init__(self, record: Record) -> None:
        self._record = record

    def noticed(self, after_s: float, clock: str) -> None:
        """Take the seconds from the fault to its first sign, and on which clock they were counted."""
        self._record("noticed_s", f"{after_s:.3f}")
        self._record("noticed_on", clock)

    def prevented(self, why: str) -> None:
        """Take why there is nothing to notice: the product refuses the fault or is immune to it."""
        self._record("prevented", why)

    def shows(self, text: str) -> None:
        """Take the sentence, or its part, that a user was shown or answered."""
        self._record("shown", str(text))

    def shows_nothing(self, why: str) -> None:
        """Take why no user has to be told."""
        self._record("shown", f"nothing: {why}")

    def recovers(self, how: str, after_s: float | None = None) -> None:
        """Take what ended the fault, and how long after its cause was gone."""
        self._record("recovery", how if after_s is None else f"{how}, {after_s:.1f} s after its cause")
