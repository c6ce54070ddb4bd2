"""`python -m tests.web.hasty_panel FOLDER PORT`: a panel alone, whose clock runs fifteen times as fast."""

import asyncio
import sys
from datetime import datetime
from pathlib import Path

from app.clock import SystemClock
from app.settings import Settings
from app.web.main import run

FASTER = 15


class HastyClock(SystemClock):
    """The system's clock, faster."""

    def __init__(self) -> None:
        super().__init__()
        self._began = super().now()

    def now(self) -> datetime:
        return self._began + (super().now() - self._began) * FASTER

    async def sleep_until(self, at: datetime) -> None:
        await asyncio.sleep(max(0.0, (at - self.now()).total_seconds() / FASTER))


if __name__ == "__main__":
    run(Settings(data_dir=Path(sys.argv[1]), port=int(sys.argv[2]), log_format="json"), HastyClock())
