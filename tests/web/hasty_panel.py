"""`python -m tests.web.hasty_panel FOLDER PORT`: a panel alone, whose clock runs fifteen times as fast.

At each SIGUSR1 a minute more has passed; at a SIGUSR2 it stands, and at the next it goes on.
"""

import asyncio
import signal
import sys
from datetime import datetime, timedelta
from pathlib import Path

from app.base.clock import SystemClock
from app.base.settings import Settings
from app.web.main import run

FASTER = 15
LOOK_EVERY_S = 0.02


class HastyClock(SystemClock):
    """The system's clock, faster, which is moved on by a minute and stands when it is told to."""

    def __init__(self) -> None:
        super().__init__()
        self._began = super().now()
        self._skipped = timedelta()
        self._stands_at: datetime | None = None
        signal.signal(signal.SIGUSR1, lambda *_: self._skip(timedelta(minutes=1)))
        signal.signal(signal.SIGUSR2, lambda *_: self._stand_or_go_on())

    def now(self) -> datetime:
        return self._stands_at or self._runs()

    def _runs(self) -> datetime:
        return self._began + (super().now() - self._began) * FASTER + self._skipped

    def _skip(self, more: timedelta) -> None:
        self._skipped += more

    def _stand_or_go_on(self) -> None:
        if self._stands_at is None:
            self._stands_at = self._runs()
        else:
            self._skip(self._stands_at - self._runs())
            self._stands_at = None

    async def sleep_until(self, at: datetime) -> None:
        # A signal is no event of the loop: looking now and then is what is left.
        while (left_s := (at - self.now()).total_seconds()) > 0:  # noqa: ASYNC110
            await asyncio.sleep(min(LOOK_EVERY_S, left_s / FASTER))


if __name__ == "__main__":
    run(Settings(data_dir=Path(sys.argv[1]), port=int(sys.argv[2]), log_format="json"), HastyClock())
