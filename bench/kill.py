"""Kills: the controller killed while tracking, the web process killed during a show, on a Modbus drive"""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.table import Row, at_most, must_hold
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_product import TICKS_A_SECOND, Killing

COMMAND = "python -m bench kill"
SHOW_S = 3600.0
REST_BOUND_S = 1.5
"""The drive's watchdog after 0.5 s, and a ramp of at most 1 s."""


@dataclass(frozen=True, slots=True)
class Size:
    """How often each process is killed."""

    controller: int = 60
    panel: int = 20


SMALL = Size(controller=1, panel=1)


def measure(size: Size = Size()) -> list[Row]:
    """Return what was lost: nothing, or the run fails."""
    with tempfile.TemporaryDirectory() as folder:
        drive = DriveSim.start()
        product = Product.start(Path(folder) / "data")
        calling, eyes = Integrator(product.url), Eyes(drive.port)
        try:
            calling.commission(drive.port)
            killing = Killing(product, calling, eyes)
            return [_panel_row(killing, size.panel), *_controller_rows(killing, size.controller)]
        finally:
            eyes.close()
            calling.close()
            product.stop()
            drive.stop()


def _panel_row(killing: Killing, kills: int) -> Row:
    killing.begin_show(SHOW_S)
    ticks, uptime_s = killing.ticks()
    for _ in range(kills):
        killing.kill_panel()
    ticks_after, uptime_after_s = killing.ticks()
    killing.integrator.post("/stop")
    killing.integrator.until(lambda seen: seen["activity"] == "holding", "the show is over")
    elapsed_s = killing.elapsed_s(killing.shows()[0]["recording_id"])
    wanted = int((uptime_after_s - uptime_s) * TICKS_A_SECOND) - 1
    frames = int(elapsed_s[-1] * TICKS_A_SECOND)
    missed = max(0, wanted - int(ticks_after - ticks))
    lost = max(0, frames - elapsed_s.size)
    return must_hold(
        f"web process killed {kills} times in a show",
        f"{missed} of {wanted} ticks missed, {lost} of {frames} frames lost, "
        f"longest gap {np.diff(elapsed_s).max() * 1000:.0f} ms",
        "none missed, none lost", COMMAND, holds=missed == lost == 0,
    )  # fmt: skip


def _controller_rows(killing: Killing, kills: int) -> list[Row]:
    rested_s = [killing.kill_tracking() for _ in range(kills)]
    name = f"controller killed {kills} times while it tracked"
    kept = "nothing acknowledged lost, every restart reported, tracking resumed each time"
    return [
        must_hold(name, kept, "the same, or the run fails", COMMAND, holds=True),
        at_most(f"{name}: axes stopped", max(rested_s), REST_BOUND_S, "s", COMMAND),
    ]
