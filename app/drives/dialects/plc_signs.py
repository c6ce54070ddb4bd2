"""Signs that a PLC's program runs and heeds us: heartbeat, echo of the keep-alive value, watchdog."""

from collections.abc import Callable, Sequence

from app.base.message import say
from app.drives.profile import Profile
from app.modbus.errors import DriveError
from app.tracker.values.motion import Feedback

MOST_UNCHANGED = 3


class SignsOfLife:
    """Looks at every reading; raises `DriveError` while a sign is missing.

    The heartbeat must change between any two readings, the echo between any two with a keep-alive value
    written in between. A watchdog that was ever on must not be off while an axis turns: without it nothing
    would stop the axis if contact were lost.
    """

    def __init__(self, profile: Profile, where: Callable[[], str]) -> None:
        self._profile = profile
        self._where = where
        self._unchanged: dict[str, tuple[int, int]] = {}
        self._fed = False
        self._watchdog_ms: int | None = None
        self._was_on = False

    @property
    def watchdog_s(self) -> float | None:
        """Return the watchdog's time-out as it was read last, the profile's before, None for none."""
        watchdog = self._profile.watchdog
        if watchdog is None:
            return None
        milliseconds = watchdog.timeout_ms if self._watchdog_ms is None else self._watchdog_ms
        return milliseconds / 1000.0 or None

    def fed(self) -> None:
        """Note that the PLC took a new keep-alive value, which it has to echo."""
        self._fed = True

    def watch(self, words: Sequence[int], first_address: int) -> None:
        """Look at heartbeat and echo of one reading."""
        where = self._where()
        self._watch(
            "heartbeat", words, first_address,
            say("The drive at {where} answers, but its heartbeat does not change: its readings are "
            "out of date. Check that the program in the drive is running.", where=where),
        )  # fmt: skip
        if self._fed:
            self._fed = False
            self._watch(
                "echo", words, first_address,
                say("The drive at {where} answers, but does not echo the keep-alive value. Check that "
                "the program in the drive is running.", where=where),
            )  # fmt: skip

    def watch_watchdog(self, words: Sequence[int], first_address: int, feedback: Feedback) -> None:
        """Look at the watchdog's time-out of one reading."""
        watchdog = self._profile.watchdog
        if watchdog is None or watchdog.readback is None:
            return
        milliseconds = self._profile.registers[watchdog.readback].integer(words, first_address)
        self._was_on = self._was_on or milliseconds > 0
        self._watchdog_ms = milliseconds
        if not milliseconds and self._was_on and (feedback.azimuth.moving or feedback.elevation.moving):
            raise DriveError(
                say(
                    "The watchdog of the drive at {where} was switched off during motion. Switch it on "
                    "again: without it, the axes do not stop when communication is lost.",
                    where=self._where(),
                )
            )

    def _watch(self, name: str, words: Sequence[int], first_address: int, still: str) -> None:
        register = self._profile.registers.get(name)
        if register is None:
            return
        value = register.integer(words, first_address)
        last, times = self._unchanged.get(name, (None, 0))
        times = times + 1 if value == last else 0
        self._unchanged[name] = (value, times)
        if times >= MOST_UNCHANGED:
            raise DriveError(still)
