"""What recordings gain, handed to the store all at once: writing costs more than what is written."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta

import numpy as np

from app.site.recording.write_queue import Ledger
from app.store.store import Recorded
from app.tracker.memory.recording import Frames, RecordingInfo

MOST_WAITING = 3600
"""How many samples of a recording wait at most; where the disk takes none, the oldest go first."""
AGAIN_AFTER = timedelta(seconds=10)
NOTHING = Recorded()


@dataclass(slots=True)
class SampleBatches:
    """Collects, and hands over every so often, or soon where a recording began or ended.

    Only one batch is on its way at a time. One that could not be stored comes back and goes with the next.
    """

    ledger: Ledger
    every: timedelta
    _waiting: Recorded = NOTHING
    _under_way: Recorded = NOTHING
    _returned: deque[Recorded] = field(default_factory=deque)
    handed_over_at: datetime | None = None

    @property
    def samples_waiting(self) -> int:
        """Return how many samples are collected and not yet on the disk."""
        batches = (self._waiting, self._under_way, *self._returned)
        return sum(len(frames) for batch in batches for frames in batch.samples.values())

    def begin(self, info: RecordingInfo) -> None:
        """Have a recording opened."""
        self._waiting = joined(self._waiting, Recorded(begun=(info,)))

    def add(self, samples: Mapping[str, Frames]) -> None:
        """Have samples added to recordings."""
        self._waiting = joined(self._waiting, Recorded(samples=samples))

    def end(self, recording_id: str, at: datetime, outcome: str) -> None:
        """Have a recording closed."""
        self._waiting = joined(self._waiting, Recorded(ended=((recording_id, at, outcome),)))

    def is_due(self, now: datetime) -> bool:
        """Return whether it is time to hand over what waits."""
        if self.handed_over_at is None:
            self.handed_over_at = now
        since = now - self.handed_over_at
        if self._under_way is not NOTHING:
            return False
        if self._returned:
            return since >= min(self.every, AGAIN_AFTER)
        return since >= self.every or bool(self._waiting.begun or self._waiting.ended)

    def hand_over(self, now: datetime) -> None:
        """Hand what waits to the store, in one transaction."""
        batch, self._waiting, self.handed_over_at = self._waiting, NOTHING, now
        while self._returned:
            batch = joined(self._returned.pop(), batch)
        if batch.is_empty and not self.ledger.has_along:
            return
        self._under_way = batch
        self.ledger.post_together(
            lambda store: store.keep_recorded(batch), lambda stored: self._finished(batch, stored)
        )

    def _finished(self, batch: Recorded, stored: bool) -> None:
        """Take the next batch from now on, and one that was not stored back; on the writer's thread."""
        if not stored:
            self._returned.append(batch)
        self._under_way = NOTHING


def joined(older: Recorded, newer: Recorded) -> Recorded:
    """Return what two batches hold as one."""
    samples = dict(older.samples)
    for name, frames in newer.samples.items():
        before = samples.get(name)
        values = frames.values if before is None else np.concatenate([before.values, frames.values])
        samples[name] = Frames(values[-MOST_WAITING:])
    return Recorded(older.begun + newer.begun, samples, older.ended + newer.ended)
