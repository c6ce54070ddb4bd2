"""Finds the best step programs for a day, in the worker."""

import numpy as np

from app.energy.equatorial import NOON_H, daylight_h, declination_deg
from app.energy.meliss import Beam, beam_of_day
from app.energy.optimiser import Limits, Optimum, best_number, best_programs
from app.energy.programmed import equatorial_mount, solar_hours
from app.energy.stepping import EVENING_H, MORNING_H, SolarDay, fixed_whm2, following_whm2
from app.studies.jobs import CLEAR_SKIES, ProgramAnswer, ProgramLight, ProgramQuestion, ProgramRow
from app.studies.light import clear_light, midnights_s
from app.sun.trigonometry import ARRAY, Array
from app.tracker.mounts.kinematics import angles

SAMPLE_H = 1.0 / 30.0
CURVE_POINTS = 97


def find_programs(asked: ProgramQuestion) -> ProgramAnswer:
    """Return the best program of every number of steps, and which number is best."""
    day = _day(asked)
    limits = Limits(
        range_deg=asked.range_deg,
        step_h=asked.step_s / 3600.0,
        per_whm2=asked.area_m2 * asked.efficiency,
        degree_wh=asked.degree_wh,
        move_wh=asked.move_wh,
    )
    found = best_programs(day, asked.most_steps, limits, asked.tilt_deg)
    hours = np.linspace(day.begin_h, day.end_h, CURVE_POINTS)
    best = best_number(found)
    return ProgramAnswer(
        question=asked,
        rows=_rows(found),
        best=best.count,
        fixed_wh=limits.per_whm2 * fixed_whm2(day, day.latitude_deg),
        continuous_wh=limits.per_whm2 * following_whm2(day, best.steps.tilt_deg, asked.range_deg),
        declination_deg=day.declination_deg,
        start_h=day.begin_h,
        end_h=day.end_h,
        hours=tuple(hours.tolist()),
        beam_wm2=tuple(day.beam(hours).tolist()),
    )


def _rows(found: tuple[Optimum, ...]) -> tuple[ProgramRow, ...]:
    rows, before_wh = [], found[0].electric_wh
    for one in found:
        rows.append(
            ProgramRow(
                one.count,
                one.electric_wh,
                one.electric_wh - before_wh,
                one.drives_wh,
                one.net_wh,
                one.steps.tilt_deg,
                one.steps.travel_deg,
                one.steps.starts_h,
                one.steps.angles_deg,
            )
        )
        before_wh = one.electric_wh
    return tuple(rows)


def _day(asked: ProgramQuestion) -> SolarDay:
    number = asked.on.timetuple().tm_yday
    latitude_deg = asked.location.latitude_deg
    if asked.light is ProgramLight.MELISS:
        sun_deg = declination_deg(number)
        beam = beam_of_day(latitude_deg, sun_deg, number, asked.turbidity)
    else:
        sun_deg, beam = _clear(asked)
    begin_h, end_h = daylight_h(latitude_deg, sun_deg)
    if asked.window:
        begin_h, end_h = max(begin_h, MORNING_H), min(end_h, EVENING_H)
    return SolarDay(latitude_deg, sun_deg, beam, begin_h, end_h)


def _clear(asked: ProgramQuestion) -> tuple[float, Beam]:
    """Return the sun's declination at noon and the beam of one of pvlib's clear skies over solar time."""
    place = asked.location
    noon_s = midnights_s((asked.on,), place.longitude_deg / 15.0)[0] + 43_200.0
    at_s = noon_s + 3600.0 * np.arange(-NOON_H, NOON_H, SAMPLE_H)
    light = clear_light(CLEAR_SKIES[asked.light], place, at_s)
    azimuth_deg, elevation_deg = light.sun_azimuth_deg, light.sun_elevation_deg
    solar_h = solar_hours(place.latitude_deg, azimuth_deg, elevation_deg)
    mount = equatorial_mount(place.latitude_deg)
    _, above_deg = angles(mount, azimuth_deg, elevation_deg, ARRAY)
    order = np.argsort(solar_h)
    known_h, direct_wm2 = solar_h[order], light.direct_wm2[order]

    def beam(hours: Array) -> Array:
        return np.asarray(np.interp(hours, known_h, direct_wm2), dtype=np.float64)

    return float(above_deg[np.abs(solar_h - NOON_H).argmin()]), beam
