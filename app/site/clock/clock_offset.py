"""How far the site's clock is off by all that is known: NTP, small steps that nobody answers for, the sun."""

from dataclasses import dataclass
from datetime import timedelta

from app.base.message import N_, say, with_format
from app.site.clock.ntp import KernelClock
from app.tracker.values.reason import Reason

WARNED_FROM = timedelta(seconds=30)
DOUBTED_FROM = timedelta(minutes=5)
"""The sun moves by 1.25 degrees in this time."""
HINT = N_("Compare the clock in the header with a reliable clock, and set or confirm it in step 2.")
NOTHING = timedelta(0)


@dataclass(slots=True)
class ClockOffset:
    """Collects the evidence since somebody last answered for the clock: the operator, or NTP."""

    kernel: KernelClock | None = None
    crept: timedelta = NOTHING
    by_sun: timedelta | None = None

    def moved(self, by: timedelta) -> None:
        """Take in that the wall clock moved against the steady one; by NTP that is a correction."""
        self.crept = NOTHING if self.is_kept else self.crept + by

    def forget(self) -> None:
        """Take the operator's word that the clock is right."""
        self.crept, self.by_sun = NOTHING, None

    @property
    def is_kept(self) -> bool:
        """Return whether NTP keeps the clock."""
        return self.kernel is not None and self.kernel.synchronised

    @property
    def seconds(self) -> float | None:
        """Return the largest of what is known, positive where the clock is fast; None if nothing is."""
        known = [self.crept, self.by_sun or NOTHING]
        if self.kernel is not None and self.is_kept:
            known.append(timedelta(seconds=-self.kernel.offset_s))
        elif self.crept == NOTHING and self.by_sun is None:
            return None
        return max(known, key=abs).total_seconds()

    def warnings(self) -> tuple[Reason, ...]:
        """Return what is said of a clock that is off by more than 30 s but may still be relied on."""
        return tuple(one for off, one in self._told_as("clock_drifts") if abs(off) <= DOUBTED_FROM)

    def reasons(self) -> tuple[Reason, ...]:
        """Return why the clock must not be relied on: it is off by more than 5 minutes."""
        return tuple(one for off, one in self._told_as("clock_off") if abs(off) > DOUBTED_FROM)

    def _told_as(self, code: str) -> list[tuple[timedelta, Reason]]:
        found = []
        if abs(self.crept) > WARNED_FROM:
            text = say(
                "The controller's clock has drifted by {total_seconds} s since it was set, and no "
                "NTP server corrects it.",
                total_seconds=with_format(self.crept.total_seconds(), "+.0f"),
            )
            found.append((self.crept, Reason(code, text, HINT)))
        if self.by_sun is not None and abs(self.by_sun) > WARNED_FROM:
            minutes = abs(self.by_sun.total_seconds()) / 60.0
            text = (
                say(
                    "The sun sightings show that the clock is {minutes} minutes fast.",
                    minutes=with_format(minutes, ".1f"),
                )
                if self.by_sun > NOTHING
                else say(
                    "The sun sightings show that the clock is {minutes} minutes slow.",
                    minutes=with_format(minutes, ".1f"),
                )
            )
            found.append((self.by_sun, Reason(code, text, HINT)))
        return found
