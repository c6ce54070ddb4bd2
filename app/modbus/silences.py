"""Which devices of a bus do not answer, and when each is asked again: the others must not wait for them."""

from datetime import UTC, datetime, timedelta

SILENT_TIMES = 3
"""So often one device may be silent before it rests; where another is silent too, once is enough."""
LONG_AGO = datetime.min.replace(tzinfo=UTC)
FIRST_REST = timedelta(milliseconds=250)
LONGEST_REST = timedelta(seconds=4)
WHOLE_LINE = 2
OTHERS_SHARE = 4
"""So many times as long as the wait for a silent device lasted, no other silent one is asked."""


class Silences:
    """Counts replies that did not come. When a silent device answers, all others are asked again at once."""

    def __init__(self) -> None:
        self._times: dict[object, int] = {}
        self._until: dict[object, datetime] = {}
        self._row: set[object] = set()
        self._asked: object = None
        self._next_at: datetime | None = None

    @property
    def all_silent(self) -> bool:
        """Return whether several devices were silent one after the other, and nobody has answered since."""
        return len(self._row) >= WHOLE_LINE

    def resting(self, device: object, now: datetime) -> bool:
        """Return whether a silent device is left alone for a moment; where all are silent it harms nobody."""
        until = self._until.get(device)
        if until is None or self.all_silent:
            return False
        others_turn = self._next_at is not None and now < self._next_at and self._asked is not device
        return now < until or others_turn

    def unheard(self, device: object, now: datetime, waited: timedelta) -> None:
        """Note that a device did not answer; it is asked less and less often."""
        self._row.add(device)
        times = self._times[device] = self._times.get(device, 0) + 1
        if times < SILENT_TIMES and len(self._times) == 1:
            return
        doubled = FIRST_REST * 2 ** min(max(0, times - SILENT_TIMES), 8)
        self._until[device] = now + min(LONGEST_REST, doubled)
        self._asked, self._next_at = device, now + waited * OTHERS_SHARE

    def heard(self, device: object) -> None:
        """Note that a device answered; what silenced it may be over for the others too."""
        was_silent = self._until.pop(device, None) is not None or self.all_silent
        self._row.clear()
        self._times.pop(device, None)
        if was_silent:
            self._until = dict.fromkeys(self._until, LONG_AGO)
            self._next_at = None

    def forget(self, device: object) -> None:
        """Forget a device that is gone."""
        self._row.discard(device)
        self._times.pop(device, None)
        self._until.pop(device, None)
