"""The machine killed at random instants of tracking and of a show, the panel killed under both."""

import os
import random
import signal
import sqlite3
import time
from contextlib import closing
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from app.tracker.settings.axes import AZIMUTH_DEFAULT
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product
from tests.patience import until as eventually
from tests.soak.rigs.eyes import Eyes

SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "20270621"))
WATCHDOG_S = 0.5
LATEST_FEED_S = 0.15
"""A command on its way when the machine dies feeds the watchdog once more."""
RAMP_S = AZIMUTH_DEFAULT.speed_dps / AZIMUTH_DEFAULT.acceleration_dps2
AWAY_DEG = 8.0
LONGEST_INSTANT_S = 1.2
TICKS_A_SECOND = 10
SHOW = {"start": "2027-06-21T06:00:00+03:00", "end": "2027-06-21T07:30:00+03:00"}


@dataclass
class Killing:
    """A product that is killed again and again, and what has to survive."""

    product: Product
    integrator: Integrator
    eyes: Eyes
    names: list[str] = field(default_factory=list)
    chance: random.Random = field(default_factory=lambda: random.Random(SEED))

    def kill_tracking(self) -> float:
        """Kill the machine on its way to the sun; return after how long the axes stood, all else checked.

        The zero is trusted still, so that tracking goes on by itself after the restart.
        """
        self._stop()
        self.integrator.until_allowed("move")
        away = self.integrator.snapshot()["sun"]["azimuth_deg"] - AWAY_DEG
        self.integrator.command("move", azimuth_deg=away, elevation_deg=5.0)
        self._until(lambda seen: seen["activity"] == "holding", "the panel is away from the sun")
        self.integrator.command("track")
        rested_s = self._kill()
        self._until(lambda seen: seen["activity"] == "tracking", "tracking goes on by itself")
        return rested_s

    def kill_show(self) -> float:
        """Kill the machine in a show; return after how long the axes stood, all else checked."""
        self._stop()
        self.integrator.until_allowed("go_to_start")
        before = len(self.shows())
        self.begin_show(20.0)
        rested_s = self._kill()
        shows = self.shows()
        assert len(shows) == before + 1
        assert all(show["ended_at"] is not None for show in shows)
        assert "interrupted" in shows[0]["outcome"]
        assert shows[0]["sample_count"] == self._frames(shows[0]["recording_id"])["elapsed_s"].size
        assert self.integrator.snapshot()["activity"] == "holding"
        assert shows[0]["recording_id"] in self.integrator.journal("controller_started")[0]["data"]["cut_off"]
        return rested_s

    def begin_show(self, seconds: float) -> None:
        """Go to the start of the show and run it."""
        show_id = self.integrator.post("/shows", {**SHOW, "duration_s": seconds})["show_id"]
        self.integrator.post(f"/shows/{show_id}/go-to-start")
        seen = self.integrator.until(
            lambda seen: not seen["show"] or seen["show"]["phase"] == "ready", "the show is ready"
        )
        assert seen["show"], self.integrator.journal("show_ended")[0]["message"]
        self.integrator.post(f"/shows/{show_id}/run")

    def kill_panel(self) -> None:
        """Kill the panel and wait until it serves again."""
        panels = len(self.product.starts("web"))
        self.product.signal("web", signal.SIGKILL)
        eventually(lambda: len(self.product.starts("web")) > panels, "the panel is started again")
        self.product.until_ready()

    def metric(self, name: str) -> float:
        """Return a number that the product tells a monitor."""
        lines = self.integrator.call("GET", "/api/v1/metrics").text.splitlines()
        return next(float(line.rpartition(" ")[2]) for line in lines if line.startswith(f"heliopanel_{name}"))

    def ticks(self) -> tuple[float, float]:
        """Return the ticks so far and the seconds for which the machine has run."""
        return self.metric("tracker_ticks_total"), self.metric("uptime_s")

    def shows(self) -> list[dict[str, Any]]:
        """Return the recorded shows, newest first."""
        found: list[dict[str, Any]] = self.integrator.get("/api/v1/recordings", kind="show")["items"]
        return found

    def elapsed_s(self, recording_id: str) -> np.ndarray:
        """Return when each frame of a recording was taken, seconds since it began."""
        return self._frames(recording_id)["elapsed_s"]

    def _frames(self, recording_id: str) -> dict[str, np.ndarray]:
        frames = self.integrator.get(f"/api/v1/recordings/{recording_id}/samples")
        return {name: np.array(values, dtype=np.float64) for name, values in frames["columns"].items()}

    def _kill(self) -> float:
        machines = len(self.product.starts("controller"))
        time.sleep(self.chance.uniform(0.0, LONGEST_INSTANT_S))
        self.names.append(f"Run {len(self.names)}")
        self.integrator.call("PATCH", "/api/v1/site", json={"name": self.names[-1]})
        rested_s = self._dead_until_rest()
        eventually(lambda: len(self.product.starts("controller")) > machines, "the machine is started again")
        self.product.until_ready()
        self.integrator.until(lambda seen: seen["measured"], "the drive is found again")
        self._check_nothing_lost()
        return rested_s

    def _dead_until_rest(self) -> float:
        """Kill the machine; its supervisor is kept from starting it again until the drive has stopped."""
        self.product.process.send_signal(signal.SIGSTOP)
        try:
            at = self.product.signal("controller", signal.SIGKILL)
            return self.eyes.first_rest_after(at)
        finally:
            self.product.process.send_signal(signal.SIGCONT)

    def _check_nothing_lost(self) -> None:
        assert self.integrator.get("/api/v1/site")["site_name"] == self.names[-1]
        told = [event["message"] for event in reversed(self.integrator.journal("tracker_changed"))]
        assert told[-len(self.names) :] == [f"The site is now called {name}." for name in self.names]
        starts = len(self.names) + 1
        eventually(lambda: len(self.integrator.journal("controller_started")) >= starts, "the start is told")
        started = self.integrator.journal("controller_started")
        assert len(started) == starts, self.product.deaths()
        assert started[0]["data"]["clean"] is False
        assert "unexpectedly" in started[0]["message"]
        path = self.product.data_dir / "heliopanel.db"
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as database:
            assert database.execute("PRAGMA quick_check").fetchall() == [("ok",)]

    def _stop(self) -> None:
        self.integrator.post("/stop")

    def _until(self, reached: Any, what: str) -> None:
        self.integrator.until(reached, what)
