"""`python -m tests.web.hasty_panel FOLDER PORT`: a panel alone, whose clock moves when it is told to.

At each SIGUSR1 a moment has passed, at each SIGUSR2 a minute.
"""

import signal
import sys
from datetime import datetime, timedelta
from pathlib import Path

from app.base.clock import SystemClock
from app.base.settings import Settings
from app.web.main import run
from tests.patience import pause

MOMENT, MINUTE = timedelta(seconds=0.3), timedelta(minutes=1)


class ToldClock(SystemClock):
    """A clock that stands at the instant of its start until a signal moves it on."""

    def __init__(self) -> None:
        super().__init__()
        self._at = super().now()
        for number, by in ((signal.SIGUSR1, MOMENT), (signal.SIGUSR2, MINUTE)):
            signal.signal(number, lambda *_, by=by: self._move(by))

    def now(self) -> datetime:
        return self._at

    def _move(self, by: timedelta) -> None:
        self._at += by

    async def sleep_until(self, at: datetime) -> None:
        # A signal is no event of the loop: looking now and then is what is left.
        while self.now() < at:
            await pause()


if __name__ == "__main__":
    run(Settings(data_dir=Path(sys.argv[1]), port=int(sys.argv[2]), log_format="json"), ToldClock())
