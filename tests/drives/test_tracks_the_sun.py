"""The controller follows the sun of NREL's SPA, as pvlib computes it, on a drive behind Modbus TCP."""

from datetime import UTC, datetime, timedelta

import pandas as pd
import pvlib

from app.base.angles import separation_deg
from app.site.weather.sky import Sky
from app.sun.position import Algorithm
from app.tracker.commands.commands import Command, Home, SelectMode, Track
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory
from app.tracker.memory.observation import Observation
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Snapshot
from app.tracker.values.mode import Mode
from tests.amount import amount
from tests.drives.rigs import STRIDE, modbus_rig
from tests.tracker.plant import SAMSUN

BEGIN = datetime(2026, 6, 21, 9, tzinfo=UTC)
TRACKER = TrackerConfig("T1", "Tracker 1", refraction=False)
MODEL_DEG = 0.01


async def test_the_panel_keeps_to_the_sun_of_spa_on_a_drive_behind_a_socket() -> None:
    async with modbus_rig() as rig:
        sky, ahead = Sky(), BEGIN - rig.clock.now()
        controller = Controller(TRACKER, TrackerMemory(), rig.drive.capabilities)

        async def tick(*asked: Command) -> Snapshot:
            rig.clock.advance(STRIDE)
            now = rig.clock.now()
            at = now + ahead
            for command in asked:
                controller.handle(command, now, "technician")
            sun, dawn = (of(SAMSUN, Algorithm.PSA, at) for of in (sky.sun, sky.dawn))
            seen = Observation(now, at, sun, dawn, await rig.drive.read(), True, SAMSUN, 1)
            command, _ = controller.tick(seen)
            await rig.drive.write(command)
            return controller.snapshot(at)

        await tick()
        shown = await tick(Home())
        while not shown.homed or shown.activity is not ActivityName.HOLDING:
            shown = await tick()
        shown = await tick(SelectMode(Mode.DUAL), Track())
        while not shown.in_position:
            shown = await tick()
        rows = []
        end = rig.clock.now() + timedelta(minutes=amount(5, 240))
        while rig.clock.now() < end:
            measured = (await tick()).measured
            assert measured is not None
            at_s = (rig.clock.now() + ahead).timestamp()
            rows.append((at_s, measured.azimuth_deg, measured.elevation_deg))
        true = rig.machine.true_orientation

    times = pd.to_datetime([row[0] for row in rows], unit="s", utc=True)
    place = (SAMSUN.latitude_deg, SAMSUN.longitude_deg)
    spa = pvlib.solarposition.get_solarposition(
        times, *place, altitude=SAMSUN.altitude_m, method="nrel_numpy"
    )
    suns = zip(spa["azimuth"], spa["elevation"], strict=True)
    off_deg = [separation_deg(*row[1:], *sun) for row, sun in zip(rows, suns, strict=True)]
    assert rows[-1][1] - rows[0][1] > 1.0
    assert TRACKER.deadband_deg / 2.0 < max(off_deg) <= TRACKER.deadband_deg + MODEL_DEG
    assert separation_deg(true.azimuth_deg, true.elevation_deg, *rows[-1][1:]) < 0.5, "the panel itself"
