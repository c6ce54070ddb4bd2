"""A site at a glance: what each mode collects in a year, and what each deadband costs in motion and error.

The year goes minute by minute under a clear sky, with the sun of NREL SPA; the deadbands go tick by tick, a
second each, through the closed loop of twelve representative days. In less than a second where the extra
`fast` is installed; without it on four days instead, in up to a quarter of a minute.
"""

from datetime import UTC, datetime

import numpy as np

from app.fast.comparison import ClearSky, Comparison, DeadbandWorth, ModeWorth
from app.fast.compiled import COMPILED
from app.fast.directions import directions
from app.fast.park import park_day
from app.fast.spa_table import build
from app.fast.sun import spa_path
from app.fast.year import collected_whm2
from app.sun.position import Location
from app.sun.trigonometry import Array
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.mode import Mode

DEADBANDS_DEG = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0)
REPRESENTATIVE_DAYS = (17, 47, 75, 105, 135, 162, 198, 228, 258, 288, 318, 344)
"""Day of the year whose declination is each month's mean (Klein 1977, doi:10.1016/0038-092X(77)90001-9)."""
FOUR_SEASONS = (75, 162, 258, 344)
MINUTE_S, DAY_S = 60.0, 86_400.0


def compare(
    config: TrackerConfig, location: Location, year: int, held: Orientation, sky: ClearSky
) -> Comparison:
    """Return what modes and deadbands are worth at a place in a year.

    `held` is what the fixed panel faces; the other modes hold the angle of the axis that does not follow.
    """
    collected = year_whm2(location, year, held, sky)
    fixed = collected[Mode.FIXED]
    modes = tuple(
        ModeWorth(mode, found / 1000.0, 100.0 * (found / fixed - 1.0)) for mode, found in collected.items()
    )
    days = REPRESENTATIVE_DAYS if COMPILED else FOUR_SEASONS
    return Comparison(year, location, held, len(days), modes, _deadbands(config, location, year, days))


def year_whm2(location: Location, year: int, held: Orientation, sky: ClearSky) -> dict[Mode, float]:
    """Return what each mode collects in a year at one minute, Wh/m2."""
    begin_s, end_s = (datetime(at, 1, 1, tzinfo=UTC).timestamp() for at in (year, year + 1))
    at_unix_s = np.arange(begin_s, end_s, MINUTE_S)
    sun = spa_path(build(begin_s, end_s - MINUTE_S), location, at_unix_s)
    days = round((end_s - begin_s) / DAY_S)
    outside_wm2 = np.repeat(extraterrestrial_wm2(np.arange(1.0, days + 1.0)), round(DAY_S / MINUTE_S))
    return collected_whm2(sun, outside_wm2, MINUTE_S, held, sky)


def extraterrestrial_wm2(day_of_year: Array) -> Array:
    """Return the irradiance outside the air, W/m2, as pvlib has it: J. Spencer, Search 2 (1971) 172."""
    turn = 2.0 * np.pi * (day_of_year - 1.0) / 365.0
    once = 1.00011 + 0.034221 * np.cos(turn) + 0.00128 * np.sin(turn)
    return np.asarray(1366.1 * (once + 0.000719 * np.cos(2 * turn) + 7.7e-05 * np.sin(2 * turn)))


def _deadbands(
    config: TrackerConfig, location: Location, year: int, days_of_year: tuple[int, ...]
) -> tuple[DeadbandWorth, ...]:
    count = len(DEADBANDS_DEG)
    none = np.zeros(count)
    days = []
    for day in days_of_year:
        noon_s = datetime(year, 1, 1, 12, tzinfo=UTC).timestamp() + (day - 1) * DAY_S
        midnight_s = noon_s - location.longitude_deg * 240.0 - DAY_S / 2.0
        aims = directions(
            config, Mode.DUAL, Orientation(180.0, 45.0), location, midnight_s + np.arange(DAY_S)
        )
        days.append(
            park_day(
                config,
                aims,
                deadband_deg=np.array(DEADBANDS_DEG),
                azimuth_offset_deg=none,
                elevation_offset_deg=none,
            )
        )
    return tuple(
        DeadbandWorth(
            deadband_deg=deadband_deg,
            moves_a_day=float(np.mean([day.moves[k] for day in days])),
            azimuth_travel_deg=float(np.mean([day.azimuth_travel_deg[k] for day in days])),
            elevation_travel_deg=float(np.mean([day.elevation_travel_deg[k] for day in days])),
            worst_off_deg=float(np.max([day.worst_off_deg[k] for day in days])),
            rms_off_deg=float(np.sqrt(np.mean([day.rms_off_deg[k] ** 2 for day in days]))),
        )
        for k, deadband_deg in enumerate(DEADBANDS_DEG)
    )
