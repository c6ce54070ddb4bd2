"""The site's clock: the steady machine time plus what the operator set, and whether it may be relied on."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

from app.base.build import BUILT_AT
from app.base.clock import Clock
from app.base.instants import is_of_these_times, of_these_times
from app.base.message import N_, say, with_format
from app.site.clock.clock_offset import ClockOffset
from app.site.clock.ntp import KernelClock
from app.tracker.memory.memory import ClockSetting
from app.tracker.state.snapshot import ClockState
from app.tracker.values.reason import Reason

LARGEST_STEP = timedelta(seconds=2)
STABLE_AFTER = timedelta(seconds=60)

UNSET = Reason("clock_unset", N_("The clock has not been set."), N_("Save the clock in step 2."))


def no_drift() -> timedelta:
    """Return that the wall clock and the steady clock agree, as they do on a virtual clock."""
    return timedelta(0)


@dataclass(frozen=True, slots=True)
class Jump:
    """The system's wall clock moved against the steady clock."""

    by: timedelta


def can_be(setting: ClockSetting, now: datetime) -> bool:
    """Return whether a setting that was kept shows an instant of these times where the system shows `now`."""
    try:
        return setting.offset_s == 0.0 or is_of_these_times(now + timedelta(seconds=setting.offset_s))
    except (OverflowError, ValueError):
        return False


class Timekeeper:
    """Shows the site's time, watches the system clock for jumps and tells whether to trust it."""

    def __init__(
        self,
        clock: Clock,
        setting: ClockSetting,
        *,
        drift: Callable[[], timedelta] = no_drift,
        kernel: Callable[[], KernelClock | None] = lambda: None,
        not_before: datetime = BUILT_AT,
    ) -> None:
        self._clock = clock
        self._drift = drift
        self._kernel = kernel
        self._not_before = not_before
        self._setting = setting if can_be(setting, clock.now()) else ClockSetting()
        self._followed = drift()
        self.offset = ClockOffset(kernel())
        self._jumped_at: datetime | None = None
        self._jumped_by = timedelta(0)

    @property
    def setting(self) -> ClockSetting:
        """Return what is stored."""
        return self._setting

    def now(self) -> datetime:
        """Return the site's time."""
        return self._shift(self._setting) + self._clock.now()

    def _shift(self, setting: ClockSetting) -> timedelta:
        return self._followed + timedelta(seconds=setting.offset_s)

    def choose(self, source: str, at: datetime | None, by: str) -> ClockSetting:
        """Return the setting that shows `at` now (None: the system's time), or refuse an impossible date."""
        if source == "manual" and at is None:
            raise ValueError(N_("Enter the date and time to set on the controller's clock."))
        shown = self._clock.now() + self._followed
        wanted = shown if source == "system" or at is None else of_these_times(at).astimezone(UTC)
        if wanted < BUILT_AT:
            raise ValueError(
                say(
                    "The clock cannot be {wanted} UTC: this software was built on {built_at}. Enter "
                    "today's date.",
                    wanted=with_format(wanted, "%Y-%m-%d %H:%M"),
                    built_at=with_format(BUILT_AT, "%Y-%m-%d"),
                )
            )
        return ClockSetting(source, (wanted - shown).total_seconds(), of_these_times(wanted), by)

    def adopt(self, setting: ClockSetting) -> None:
        """Take over a setting that is stored: the operator vouches for the time, jumps are forgotten."""
        self._setting = setting
        self._jumped_at = None
        self._not_before = BUILT_AT
        self.offset.forget()

    def watch(self) -> Jump | None:
        """Look at the system's clock; return its jump since the last look, if there was one.

        A clock set by hand keeps showing the operator's time: its offset takes up the jump. What moves by
        less is followed, and counted.
        """
        self.offset.kernel = self._kernel()
        moved = self._drift() - self._followed
        self._followed += moved
        if abs(moved) <= LARGEST_STEP:
            self.offset.moved(moved)
            return None
        if self._setting.source == "manual":
            kept_s = self._setting.offset_s - moved.total_seconds()
            self._setting = replace(self._setting, offset_s=kept_s)
        self._jumped_at = self._clock.now()
        self._jumped_by = moved
        return Jump(moved)

    def reasons(self) -> tuple[Reason, ...]:
        """Return why the clock is not to be trusted; none if it is."""
        if self._setting.source == "unset":
            return (UNSET,)
        found = []
        shown = self.now()
        if not is_of_these_times(shown):
            found.append(
                Reason(
                    "clock_implausible",
                    say("The clock shows the year {year}, which cannot be right.", year=shown.year),
                    N_("Set the clock in step 2."),
                )
            )
        elif shown < self._not_before:
            found.append(
                Reason(
                    "clock_implausible",
                    say(
                        "The clock shows {shown} UTC, which is before {not_before} UTC and so cannot be "
                        "right.",
                        shown=with_format(shown, "%Y-%m-%d %H:%M"),
                        not_before=with_format(self._not_before, "%Y-%m-%d %H:%M"),
                    ),
                    N_("Set the clock in step 2."),
                )
            )
        if self._jumped_at is not None and self._clock.now() - self._jumped_at < STABLE_AFTER:
            found.append(
                Reason(
                    "clock_jumped",
                    say(
                        "The system clock jumped by {total_seconds} s.",
                        total_seconds=with_format(self._jumped_by.total_seconds(), "+.0f"),
                    ),
                    N_("Confirm the clock in step 2, or wait until it has been stable for 60 s."),
                )
            )
        return (*found, *self.offset.reasons())

    def state(self) -> ClockState:
        """Return the clock as the pages show it."""
        reasons = self.reasons()
        return ClockState(
            self._setting.source,
            self._setting.offset_s,
            not reasons,
            None if self.offset.kernel is None else self.offset.kernel.synchronised,
            self._setting.set_at,
            reasons,
            self.offset.warnings(),
            self.offset.seconds,
        )
