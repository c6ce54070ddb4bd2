"""A study from its days to its result: every mode with every strategy, one after the other."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from pvlib import pvsystem, temperature

from app.energy.holding import held_axes, separations_deg
from app.energy.ideal import AxisPath, Follower, collected_wm2, faced, ideal_axes
from app.energy.motion import drives_wh, travelled
from app.energy.programmed import equatorial_mount, program_axes, solar_hours
from app.studies.light import Days
from app.studies.rehearsed import rehearsed_axes
from app.studies.request import Fidelity, Module, Span, StudyMode, StudyRequest, StudyStrategy
from app.studies.result import CaseResult, DayCurve, StudyResult
from app.sun.trigonometry import Array
from app.tracker.settings.config import MountConfig, MountKind, Rows
from app.tracker.settings.strategy import Continuous, Deadband, Interval, Strategy
from app.tracker.values.mode import Mode

Progress = Callable[[int, int, str], None]
"""What is told of the work: cases done, cases in all, the name of the case that begins."""

MOST_CURVES = 12
MIDDLE = 15
MODES = {
    StudyMode.FIXED: Mode.FIXED,
    StudyMode.AZIMUTH: Mode.AZIMUTH,
    StudyMode.ELEVATION: Mode.ELEVATION,
    StudyMode.ELEVATION_LEAST: Mode.ELEVATION,
}


@dataclass(frozen=True, slots=True)
class Worked:
    """One case before it is summed up; arrays are days times steps, energies a day's."""

    mode: StudyMode
    strategy: StudyStrategy
    mount: MountConfig
    axes: AxisPath
    plane_wm2: Array
    power_w: Array
    drives_wh: Array
    moves: Array
    travel_deg: Array
    largest_error_deg: float


def work_out(asked: StudyRequest, days: Days, progress: Progress) -> tuple[CaseResult, ...]:
    """Return every case of a study; `progress` is told before each and after the last."""
    cases, found = asked.cases, []
    for number, (mode, strategy) in enumerate(cases):
        progress(number, len(cases), f"{mode}, {strategy}")
        found.append(_work(asked, days, mode, strategy))
    progress(len(cases), len(cases), "")
    fixed_kwh = _weighted(days, _day_wh(days, found[0]))
    return tuple(_summed(asked, days, one, fixed_kwh) for one in found)


def finished(asked: StudyRequest, days: Days, cases: Iterable[CaseResult], took_s: float) -> StudyResult:
    """Return the result; the fixed panel stays in it whether it was asked for or not."""
    return StudyResult(
        days.location, days.utc_offset_h, days.source, days.days, days.step_min, tuple(cases), took_s
    )


def follower_of(asked: StudyRequest, days: Days, mode: StudyMode) -> Follower:
    """Return the mount of a mode, what it follows and how far it turns."""
    if asked.fidelity is Fidelity.CONTROLLER and asked.tracker is not None:
        return Follower(asked.tracker.mount, MODES.get(mode, Mode.DUAL), asked.held)
    towards = 0.0 if days.location.latitude_deg < 0.0 else 180.0
    rows = Rows(asked.rows_ratio) if asked.rows_ratio > 0.0 else None
    kind = Mode.DUAL
    match mode:
        case StudyMode.EQUATORIAL:
            return Follower(equatorial_mount(days.location.latitude_deg), kind, asked.held, asked.range_deg)
        case StudyMode.HORIZONTAL_AXIS:
            mount = MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS, towards, rows=rows)
            return Follower(mount, kind, asked.held, asked.range_deg)
        case StudyMode.TILTED_AXIS:
            mount = MountConfig(MountKind.TILTED_SINGLE_AXIS, towards, asked.axis_tilt_deg, rows=rows)
            return Follower(mount, kind, asked.held, asked.range_deg)
        case StudyMode.VERTICAL_AXIS:
            tilt_deg = 90.0 - asked.held.elevation_deg
            mount = MountConfig(MountKind.VERTICAL_SINGLE_AXIS, towards, panel_tilt_deg=tilt_deg)
            return Follower(mount, kind, asked.held)
        case _:
            mount = MountConfig(least_incidence=mode is StudyMode.ELEVATION_LEAST)
            return Follower(mount, MODES.get(mode, kind), asked.held)


def _work(asked: StudyRequest, days: Days, mode: StudyMode, strategy: StudyStrategy) -> Worked:
    follower = follower_of(asked, days, mode)
    ideal = ideal_axes(days.light, follower)
    axes = ideal if mode is StudyMode.FIXED else _stood(asked, days, follower, strategy, ideal)
    plane_wm2 = np.where(days.up, collected_wm2(days.light, follower.mount, axes, asked.around), 0.0)
    moved = travelled(axes, without_rest=strategy is StudyStrategy.CONTINUOUS)
    idle = mode is StudyMode.FIXED
    off_deg = separations_deg(axes, ideal)[days.up]
    return Worked(
        mode,
        strategy,
        follower.mount,
        axes,
        plane_wm2,
        power_w(plane_wm2, days, asked.module),
        np.zeros(len(days.days)) if idle else drives_wh(moved, asked.costs),
        moved.moves.astype(np.float64),
        moved.travel_deg,
        float(off_deg.max()) if off_deg.size else 0.0,
    )


def _stood(
    asked: StudyRequest, days: Days, follower: Follower, strategy: StudyStrategy, ideal: AxisPath
) -> AxisPath:
    """Return where the axes stand instead of the ideal places."""
    if asked.fidelity is Fidelity.CONTROLLER:
        return rehearsed_axes(asked, days, follower.mode, strategy)
    if strategy is StudyStrategy.PROGRAM and asked.program is not None:
        latitude_deg = days.location.latitude_deg
        solar_h = solar_hours(latitude_deg, days.light.sun_azimuth_deg, days.light.sun_elevation_deg)
        utc_h = np.mod(days.at_unix_s / 3600.0, 24.0)
        found = program_axes(asked.program, follower.mount, latitude_deg, ideal, solar_h, utc_h)
        return _within(found, follower)
    by_sun: dict[StudyStrategy, Strategy] = {
        StudyStrategy.CONTINUOUS: Continuous(),
        StudyStrategy.DEADBAND: Deadband(),
        StudyStrategy.INTERVAL: Interval(asked.interval_min),
    }
    return held_axes(
        by_sun[strategy], ideal, days.up, step_min=days.step_min, deadband_deg=asked.deadband_deg
    )


def _within(axes: AxisPath, follower: Follower) -> AxisPath:
    if follower.range_deg is None:
        return axes
    return replace(axes, first_deg=np.clip(axes.first_deg, -follower.range_deg, follower.range_deg))


def power_w(plane_wm2: Array, days: Days, module: Module) -> Array:
    """Return the power of the panels after all losses: Faiman's cell temperature, PVWatts' module."""
    cell_degc = temperature.faiman(plane_wm2, days.air_degc, days.wind_mps)
    direct_w = pvsystem.pvwatts_dc(plane_wm2, cell_degc, module.power_w, module.per_kelvin)
    return np.asarray(np.maximum(direct_w, 0.0) * (1.0 - module.losses_percent / 100.0), dtype=np.float64)


def _summed(asked: StudyRequest, days: Days, worked: Worked, fixed_kwh: float) -> CaseResult:
    day_wh = _day_wh(days, worked)
    energy_kwh = _weighted(days, day_wh)
    drives_kwh = _weighted(days, worked.drives_wh)
    return CaseResult(
        mode=worked.mode,
        strategy=worked.strategy,
        insolation_kwhm2=_weighted(days, worked.plane_wm2.sum(axis=1) * days.step_min / 60.0),
        energy_kwh=energy_kwh,
        gross_gain_percent=_gain(energy_kwh, fixed_kwh),
        drives_kwh=drives_kwh,
        net_gain_percent=_gain(energy_kwh - drives_kwh, fixed_kwh),
        moves=round(1000.0 * _weighted(days, worked.moves)),
        travel_deg=1000.0 * _weighted(days, worked.travel_deg),
        largest_error_deg=worked.largest_error_deg,
        months_kwh=() if asked.span is Span.DAY else _months(days, day_wh),
        curves=_curves(days, worked),
        heat_wm2=() if asked.span is Span.DAY else _heat(worked.plane_wm2),
    )


def _day_wh(days: Days, worked: Worked) -> Array:
    return np.asarray(worked.power_w.sum(axis=1) * days.step_min / 60.0, dtype=np.float64)


def _weighted(days: Days, of_day: Array) -> float:
    """Return the sum over the days, each times what it stands for, in thousands."""
    return float(of_day @ np.array(days.weights)) / 1000.0


def _gain(energy_kwh: float, fixed_kwh: float) -> float:
    return 100.0 * (energy_kwh - fixed_kwh) / fixed_kwh if fixed_kwh > 0.0 else 0.0


def _months(days: Days, day_wh: Array) -> tuple[float, ...]:
    month = np.array([day.month for day in days.days])
    of_day = day_wh * np.array(days.weights) / 1000.0
    return tuple(float(of_day[month == number].sum()) for number in range(1, 13))


def _heat(plane_wm2: Array) -> tuple[tuple[int, ...], ...]:
    """Return the mean of every hour of every day, whole W/m2."""
    means = plane_wm2.reshape(len(plane_wm2), 24, -1).mean(axis=2).round().astype(int)
    return tuple(tuple(row) for row in means.tolist())


def _curves(days: Days, worked: Worked) -> tuple[DayCurve, ...]:
    """Return the curves of the days, of a year those of the middle of each month."""
    many = len(days.days) > MOST_CURVES
    rows = [row for row, day in enumerate(days.days) if not many or day.day == MIDDLE]
    azimuth_deg, elevation_deg = faced(worked.mount, worked.axes)
    azimuth_deg = np.mod(azimuth_deg, 360.0)
    return tuple(
        DayCurve(
            days.days[row],
            tuple(worked.plane_wm2[row].round().astype(int).tolist()),
            tuple(azimuth_deg[row].round(2).tolist()),
            tuple(elevation_deg[row].round(2).tolist()),
        )
        for row in rows
    )
