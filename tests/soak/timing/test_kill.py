"""Either process killed at any instant of tracking and of a show: nothing is lost, the drive stops."""

import os
from collections.abc import Iterator

import numpy as np
import pytest

from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_product import LATEST_FEED_S, RAMP_S, TICKS_A_SECOND, WATCHDOG_S, Killing

KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "2"))
PANEL_KILLS_TRACKING, PANEL_KILLS_SHOWING = 1, 1
LONGEST_SHOW_S = 90.0
TICK_S = 0.1
LATEST_S = 0.25


@pytest.fixture(scope="module")
def killing(product: Product, drive: DriveSim) -> Iterator[Killing]:
    calling, watching = Integrator(product.url), Eyes(drive.port)
    calling.commission(drive.port)
    yield Killing(product, calling, watching)
    watching.close()
    calling.close()


def test_panel_killed_no_tick_missed_and_no_frame_lost(killing: Killing) -> None:
    calling = killing.integrator
    calling.until_allowed("track")
    calling.command("track")
    ticks, uptime_s = killing.ticks()
    for _ in range(PANEL_KILLS_TRACKING):
        killing.kill_panel()
    assert calling.snapshot()["activity"] == "tracking"

    killing.begin_show(LONGEST_SHOW_S)
    for _ in range(PANEL_KILLS_SHOWING):
        killing.kill_panel()
    assert calling.snapshot()["show"]["phase"] == "running"
    ticks_after, uptime_after_s = killing.ticks()
    calling.post("/stop")
    calling.until(lambda seen: seen["activity"] == "holding", "the show is over")

    assert ticks_after - ticks >= int((uptime_after_s - uptime_s) * TICKS_A_SECOND) - 1
    (show,), (day,) = killing.shows(), calling.get("/api/v1/recordings", kind="day")["items"]
    check_frames(killing.elapsed_s(show["recording_id"]), TICK_S)
    check_frames(killing.elapsed_s(day["recording_id"]), 1.0)


def check_frames(elapsed_s: np.ndarray, step_s: float) -> None:
    """Fail if a frame is missing or came late by more than the drive's own delay."""
    assert elapsed_s.size >= int(elapsed_s[-1] / step_s)
    assert np.diff(elapsed_s).max() < step_s + LATEST_S


@pytest.mark.timeout(60 + 15 * KILLS)
def test_machine_killed_nothing_lost_and_the_drive_stopped(killing: Killing) -> None:
    for number in range(KILLS):
        rested_s = killing.kill_show() if number % 2 else killing.kill_tracking()
        print(f"at rest after {rested_s:.2f} s")
        assert rested_s <= WATCHDOG_S + LATEST_FEED_S + RAMP_S
