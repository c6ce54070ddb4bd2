"""Kills: the machine killed while it tracks, the panel killed while a show runs, on a Modbus drive"""

import os
import tempfile
from pathlib import Path

import numpy as np

from bench.table import Row
from tests.e2e.eyes import Eyes
from tests.e2e.integrator import Integrator
from tests.e2e.killing import TICKS_A_SECOND, Killing
from tests.e2e.product import DriveSim, Product

COMMAND = "python -m bench kill"
MACHINE_KILLS = int(os.environ.get("HELIOPANEL_BENCH_KILLS", "100"))
PANEL_KILLS = int(os.environ.get("HELIOPANEL_BENCH_PANEL_KILLS", "20"))
SHOW_S = 3600.0


def measure() -> list[Row]:
    """Return what was lost: nothing, or the run fails."""
    with tempfile.TemporaryDirectory() as folder:
        drive = DriveSim.start()
        product = Product.start(Path(folder) / "data")
        calling, eyes = Integrator(product.url), Eyes(drive.port)
        try:
            calling.commission(drive.port)
            killing = Killing(product, calling, eyes)
            return [_panel_row(killing), _machine_row(killing)]
        finally:
            eyes.close()
            calling.close()
            product.stop()
            drive.stop()


def _panel_row(killing: Killing) -> Row:
    killing.begin_show(SHOW_S)
    ticks, uptime_s = killing.ticks()
    for _ in range(PANEL_KILLS):
        killing.kill_panel()
    ticks_after, uptime_after_s = killing.ticks()
    killing.integrator.post("/stop")
    killing.integrator.until(lambda seen: seen["activity"] == "holding", "the show is over")
    elapsed_s = killing.elapsed_s(killing.shows()[0]["recording_id"])
    wanted = int((uptime_after_s - uptime_s) * TICKS_A_SECOND) - 1
    frames = int(elapsed_s[-1] * TICKS_A_SECOND)
    return Row(
        f"panel killed {PANEL_KILLS} times in a show",
        f"{max(0, wanted - int(ticks_after - ticks))} of {wanted} ticks missed, "
        f"{max(0, frames - elapsed_s.size)} of {frames} frames lost, "
        f"longest gap {np.diff(elapsed_s).max() * 1000:.0f} ms",
        "0",
        "",
        COMMAND,
    )


def _machine_row(killing: Killing) -> Row:
    rested_s = [killing.kill_tracking() for _ in range(MACHINE_KILLS)]
    return Row(
        f"machine killed {MACHINE_KILLS} times while it tracked",
        "nothing acknowledged lost, every restart told, tracking resumed each time; axes at rest after at "
        f"most {max(rested_s):.2f} s",
        "watchdog 0.5 s and a ramp of at most 1 s",
        "",
        COMMAND,
    )
