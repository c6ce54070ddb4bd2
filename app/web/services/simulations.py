"""Simulations and surveys run in a process of their own, so that they delay neither pages nor the machine."""

import asyncio
import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import TypeVar

from app.base.message import N_
from app.base.startup import late
from app.sun.horizon import FLAT, Horizon
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import RecordingInfo
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.weather.weather_day import WeatherDay
from app.web.http.errors import Busy

MOST_AT_ONCE = 4
LONGEST = timedelta(seconds=120)
KINDLY = 10
BUSY = N_("Other calculations are under way; try again when one of them has ended.")
TOO_LONG = N_("The calculation took too long and was canceled; choose a shorter span or a longer step.")
Simulated = tuple[RecordingInfo, tuple[str, ...]]
Asked = TypeVar("Asked")
Found = TypeVar("Found")


@dataclass(frozen=True, slots=True)
class SimulationRequest:
    """What to simulate."""

    config: TrackerConfig
    pointing: Pointing
    location: Location
    time_zone: str
    mode: Mode
    held: Orientation
    begin: datetime
    end: datetime
    step: timedelta
    title: str
    weather: WeatherDay | None = None
    horizon: Horizon = FLAT


class Simulations:
    """One worker process, started when it is first needed, and a short queue before it."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None
        self._waiting = 0

    async def run(self, request: SimulationRequest) -> Simulated:
        """Return the recording and its encoded frames; raise `Busy`, or `ValueError` for what cannot be."""
        return await self.work_out(simulated, request)

    async def work_out(self, function: Callable[[Asked], Found], asked: Asked) -> Found:
        """Return what a function of a module makes of its argument, in the worker; raise `Busy`."""
        if self._waiting >= MOST_AT_ONCE:
            raise Busy(BUSY)
        self._waiting += 1
        try:
            async with asyncio.timeout(LONGEST.total_seconds()):
                return await self._work(function, asked)
        except (TimeoutError, BrokenProcessPool) as error:
            self.close()
            raise Busy(TOO_LONG) from error
        finally:
            self._waiting -= 1

    async def _work(self, function: Callable[[Asked], Found], asked: Asked) -> Found:
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=os.nice, initargs=(KINDLY,))
        return await asyncio.get_running_loop().run_in_executor(self._pool, function, asked)

    def close(self) -> None:
        """Give up what is under way and end the worker."""
        if self._pool is None:
            return
        self._pool.shutdown(wait=False, cancel_futures=True)
        for child in multiprocessing.active_children():
            child.terminate()
        self._pool = None


def simulated(request: SimulationRequest) -> Simulated:
    """Return the simulation of a span of time, in the worker."""
    show = late("app.show.simulate")
    info, frames = show.simulate(
        request.config,
        request.pointing,
        request.location,
        request.time_zone,
        request.mode,
        request.held,
        request.begin,
        request.end,
        step=request.step,
        title=request.title,
        weather=request.weather,
    )
    return replace(info, horizon=request.horizon), show.encoded(frames)
