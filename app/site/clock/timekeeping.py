"""The site's clock: the steady machine time plus what the operator set, and whether it may be relied on."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

from app.base.build import BUILT_AT
from app.base.clock import Clock
from app.base.instants import duration, is_of_these_times, of_these_times
from app.base.message import N_, Word, say, with_format
from app.site.clock.clock_offset import NOTHING, ClockOffset
from app.site.clock.device_clocks import DeviceClocks
from app.site.clock.ntp import KernelClock
from app.tracker.access.location_change import MOST_APART
from app.tracker.memory.memory import ClockSetting
from app.tracker.state.snapshot import ClockState
from app.tracker.values.actors import LOCAL_USER
from app.tracker.values.reason import Reason

LARGEST_STEP = timedelta(seconds=2)
STABLE_AFTER = timedelta(seconds=60)

UNSET = Reason("clock_unset", N_("The clock has not been set."), N_("Save the clock in step 2."))


_COMPARE = N_("Compare both with a third clock, and set the one that is wrong: the controller's in step 2.")
_KEPT = N_("NTP keeps the controller's clock correct: set the clock of that device.")


def _minutes(length: timedelta) -> str:
    """Return a difference of clocks in words that stay the same while it is told again and again."""
    return duration(round(abs(length) / timedelta(minutes=1)) * timedelta(minutes=1))


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
        self.devices = DeviceClocks(clock)
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

    def differences(self) -> tuple[Reason, ...]:
        """Return that the clock is over a minute off another: one that NTP keeps, or that of a device."""
        by_hand = self._by_hand()
        if abs(by_hand) > MOST_APART:
            length = _minutes(by_hand)
            text = (
                say(
                    "The controller's clock was set manually, {length} ahead of the computer's clock, "
                    "which NTP keeps correct.",
                    length=length,
                )
                if by_hand > NOTHING
                else say(
                    "The controller's clock was set manually, {length} behind the computer's clock, "
                    "which NTP keeps correct.",
                    length=length,
                )
            )
            return (Reason("clock_differs", text, N_("Choose Use system clock in step 2.")),)
        device = self.devices.furthest()
        if device is None:
            return ()
        whose, length = device.whose, _minutes(device.ahead)
        who = Word(LOCAL_USER) if whose == LOCAL_USER else whose
        text = (
            say(
                "The controller's clock is {length} ahead of the clock of the device used by {who}.",
                length=length,
                who=who,
            )
            if device.ahead > NOTHING
            else say(
                "The controller's clock is {length} behind the clock of the device used by {who}.",
                length=length,
                who=who,
            )
        )
        return (Reason("clock_differs", text, _KEPT if self.offset.is_kept else _COMPARE),)

    def _by_hand(self) -> timedelta:
        """Return by how much the clock was set ahead of a clock that NTP keeps."""
        is_known = self._setting.source == "manual" and self.offset.is_kept
        return timedelta(seconds=self._setting.offset_s) if is_known else NOTHING

    def _off_s(self) -> float | None:
        """Return by how much the clock is known to be fast, None where a device differs and nobody knows."""
        if self.devices.furthest() is not None and not (self.offset.is_kept or self.offset.by_sun):
            return None
        known = (self.offset.seconds, self._by_hand().total_seconds() or None)
        return max((one for one in known if one is not None), key=abs, default=None)

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
            (*self.offset.warnings(), *self.differences()),
            self._off_s(),
        )
