"""What a study found: a table of cases, and what its pictures are drawn from."""

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date

from app.base.message import N_
from app.studies.request import StudyMode, StudyStrategy
from app.sun.position import Location

MODE_NAMES = {
    StudyMode.FIXED: N_("Fixed"),
    StudyMode.AZIMUTH: N_("Azimuth"),
    StudyMode.ELEVATION: N_("Elevation"),
    StudyMode.ELEVATION_LEAST: N_("Elevation, least incidence"),
    StudyMode.DUAL: N_("Dual-axis"),
    StudyMode.EQUATORIAL: N_("Equatorial"),
    StudyMode.HORIZONTAL_AXIS: N_("Horizontal axis"),
    StudyMode.TILTED_AXIS: N_("Tilted axis"),
    StudyMode.VERTICAL_AXIS: N_("Vertical axis"),
}
STRATEGY_NAMES = {
    StudyStrategy.CONTINUOUS: "continuous",
    StudyStrategy.DEADBAND: "deadband",
    StudyStrategy.INTERVAL: "interval",
    StudyStrategy.PROGRAM: "program",
}
HEADS = (
    "mode", "strategy", "insolation_kwhm2", "energy_kwh", "gross_gain_percent", "drives_kwh", "net_kwh",
    "net_gain_percent", "moves", "travel_deg", "largest_error_deg",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class DayCurve:
    """One day of one case: W/m2 in the plane of the panel, its azimuth and elevation, at every step."""

    on: date
    plane_wm2: tuple[int, ...]
    azimuth_deg: tuple[float, ...]
    elevation_deg: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class CaseResult:
    """One mode with one strategy. Energies are of the whole span, of twelve days scaled up to their months.

    Gains are against the fixed panel: gross, and net of what the drives take. `largest_error_deg` is the
    largest angle between panel and where the mode wants it while the sun is up. `months_kwh` is empty for a
    day; `heat_wm2` has the mean of every hour of every day, 0 to 23 h of standard time.
    """

    mode: StudyMode
    strategy: StudyStrategy
    insolation_kwhm2: float
    energy_kwh: float
    gross_gain_percent: float
    drives_kwh: float
    net_gain_percent: float
    moves: int
    travel_deg: float
    largest_error_deg: float
    months_kwh: tuple[float, ...]
    curves: tuple[DayCurve, ...]
    heat_wm2: tuple[tuple[int, ...], ...]

    @property
    def net_kwh(self) -> float:
        """Return the energy that is left after the drives are paid."""
        return self.energy_kwh - self.drives_kwh

    @property
    def label(self) -> str:
        """Return the name of the case for people."""
        if self.mode is StudyMode.FIXED:
            return MODE_NAMES[self.mode]
        return f"{MODE_NAMES[self.mode]}, {STRATEGY_NAMES[self.strategy]}"


@dataclass(frozen=True, slots=True)
class StudyResult:
    """Everything that a study found; `location` is the weather file's where there is one.

    `hours` are the middles of the steps of a day, hours of standard time, `utc_offset_h` ahead of UTC.
    """

    location: Location
    utc_offset_h: float
    source: str
    days: tuple[date, ...]
    step_min: int
    cases: tuple[CaseResult, ...]
    took_s: float

    @property
    def hours(self) -> tuple[float, ...]:
        """Return the middle of every step of a day."""
        return tuple((index + 0.5) * self.step_min / 60.0 for index in range(24 * 60 // self.step_min))


def table_csv(result: StudyResult) -> str:
    """Return the table of cases as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADS)
    for case in result.cases:
        writer.writerow([_plain(getattr(case, name)) for name in HEADS])
    return text.getvalue()


def curves_csv(result: StudyResult) -> Iterator[str]:
    """Return the curves of all days and cases as CSV, a piece a day and case."""
    yield "date,hour,mode,strategy,plane_wm2,panel_azimuth_deg,panel_elevation_deg\n"
    for case in result.cases:
        for curve in case.curves:
            columns = zip(result.hours, curve.plane_wm2, curve.azimuth_deg, curve.elevation_deg, strict=True)
            yield "".join(
                f"{curve.on},{hour:.4f},{case.mode},{case.strategy},{plane},{azimuth},{elevation}\n"
                for hour, plane, azimuth, elevation in columns
            )


def _plain(value: object) -> object:
    return f"{value:.4f}" if isinstance(value, float) else value
