"""C. Alexandru, "Simulation and Optimization of a Dual-Axis Solar Tracking Mechanism" (2024)."""

from app.energy import alexandru as model
from app.energy.alexandru import (
    PER_WHM2,
    TABLE_3_ANGLES_DEG,
    TABLE_3_STARTS_H,
    TABLE_4_DAYS,
    DayGain,
    gain_percent,
)
from app.energy.equatorial import daylight_h, declination_deg
from app.energy.stepping import Steps, clear_day, fixed_whm2, midpoint_h, stepped_whm2
from app.research import alexandru_published as published
from app.research.alexandru_actuators import actuators, beyond_stroke_mm, solstice_stroke_mm
from app.research.effect import Effect, Measured, effect, not_measured
from app.research.result import Basis, Erratum, Figure, Gap, Group, Paper
from app.research.sampling import from_spa, worse
from app.sun.algorithms import PUBLISHED, Algorithm

WITHIN_GAIN_PERCENT = 0.5
FEWER_STEPS = 8
NUMERALS = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII")
CONTINUOUS = "No turbidity gives the fixed panel, the steps and this one together."
OTHER_LATITUDE_DEG = 45.5
MOST_TURBIDITY, TURBIDITY_WITHIN = 12.0, 0.002
NAME, REFERENCE = not_measured("a name"), not_measured("a reference")


def alexandru() -> Paper:
    """Return every energy, angle and length of the paper that can be computed, and its errata."""
    return Paper(
        key="alexandru",
        name="Alexandru (2024)",
        citation="C. Alexandru, Simulation and Optimization of a Dual-Axis Solar Tracking Mechanism, "
        "Mathematics 12 (2024) 1034, doi:10.3390/math12071034.",
        groups=(
            _daylight(),
            _solstice(),
            _better(),
            _mirrored(),
            _declinations(),
            _days(),
            _gains(),
            *actuators(),
        ),
        errata=_errata(),
        gaps=GAPS,
    )


def _daylight() -> Group:
    rise_h, set_h = daylight_h(model.LATITUDE_DEG, declination_deg(model.SOLSTICE))
    other_h, _ = daylight_h(OTHER_LATITUDE_DEG, declination_deg(model.SOLSTICE))
    remark = (
        f"It follows from latitude {model.LATITUDE_DEG:.2f} as little as from {OTHER_LATITUDE_DEG:.2f}, "
        f"which gives {other_h:.3f}."
    )
    return Group(
        "Section 4, sunrise and sunset of 21 June, solar time",
        "12 ∓ acos(−tan φ tan δ)/15 with φ = 45.65° and δ of eq 8.",
        (
            Figure("sunrise", "h", published.SUNRISE_H, rise_h, 0.005, 3, remark),
            Figure("sunset", "h", published.SUNSET_H, set_h, 0.005, 3, remark),
        ),
    )


def _solstice() -> Group:
    found = model.solstice()
    return Group(
        "Section 4, figure 26 and eq 4: energies of 21 June",
        "Meliss's beam with turbidity 3.000, which the paper does not print: fitted to the "
        "fixed panel; energy of the steps counted from 6 h to 18 h solar time, of the fixed panel all day.",
        (
            Figure(
                "fixed panel", "Wh", published.FIXED_WH, found.fixed_wh, 0.02, basis=Basis.FITTED,
            ),
            Figure("program of table 3", "Wh", published.TABLE_3_WH, found.table_3_wh, 0.5),
            Figure("net gain of table 3", "%", published.GAIN_PERCENT, found.gain_percent, 0.05),
            Figure(
                "continuous, 6 h to 18 h", "Wh", published.CONTINUOUS_WH, found.continuous_wh, 0.5,
                remark=CONTINUOUS,
            ),
            Figure(
                "continuous, all day", "Wh", published.CONTINUOUS_WH, found.continuous_whole_day_wh, 0.5,
                remark=CONTINUOUS,
            ),
            Figure("program of table 3, all day", "Wh", None, found.table_3_whole_day_wh),
        ),
    )  # fmt: skip


def _better() -> Group:
    found = model.solstice()
    best_h = midpoint_h(TABLE_3_ANGLES_DEG)
    off_min = [60.0 * abs(ours - told) for ours, told in zip(best_h, TABLE_3_STARTS_H, strict=True)]
    return Group(
        "Table 3, whether it is the optimum",
        "Between two places the best instant is when the sun's hour angle is their mean, whatever the light.",
        (
            Figure("twelve steps at the best instants", "Wh", None, found.midpoint_wh),
            Figure("twelve best steps within 60°", "Wh", None, found.optimum_wh),
            Figure("eight best steps within 60°", "Wh", None, model.optimum_wh(FEWER_STEPS)),
            Figure("continuous within 60°", "Wh", None, found.within_range_wh),
            Figure("twelve best steps without limits", "Wh", None, found.optimum_without_range_wh),
            Figure("table 3's times, farthest from the best", "min", None, max(off_min), digits=1),
        ),
    )


def _mirrored() -> Group:
    pairs = zip(NUMERALS[6:], TABLE_3_STARTS_H[6:], TABLE_3_STARTS_H[5::-1], strict=True)
    return Group(
        "Table 3, afternoon",
        "The paper mirrors the morning's times at noon: 24 h less the time of the morning.",
        tuple(
            Figure(
                f"step {name}", "h", told, 24.0 - morning, 0.005, 2,
                "A misprint of 14.58." if abs(told - 24.0 + morning) > 0.005 else "", Basis.PRINTED,
            )
            for name, told, morning in pairs
        ),
    )  # fmt: skip


def _declinations() -> Group:
    figures = []
    columns = (
        published.DAY_NAMES,
        published.TABLE_4_DECLINATIONS_DEG,
        published.TABLE_4_MEANS_DEG,
        model.table_4(),
    )
    for name, told_deg, mean_deg, row in zip(*columns, strict=True):
        figures.append(Figure(f"{name}, δ", "°", told_deg, row.declination_deg, 0.0051, 3))
        figures.append(
            Figure(f"{name}, mean of the month", "°", mean_deg, row.month_declination_deg, 0.0051, 3)
        )
    return Group("Table 4, declinations", "By eq 8; the mean over every day of the month.", tuple(figures))


def _days() -> Group:
    rows = zip(published.DAY_NAMES, TABLE_4_DAYS, strict=True)
    remark = "The day of June nearest to the month's mean is 30 June."
    return Group(
        "Table 4, representative days",
        "The day whose declination is nearest to its month's mean, as the paper defines it.",
        tuple(
            Figure(
                name, "day of the year", float(told), float(found := model.representative_day(month)), 0.0, 0,
                "" if found == told else remark,
            )
            for month, (name, told) in enumerate(rows, start=1)
        ),
    )  # fmt: skip


def _gains() -> Group:
    rows = zip(published.DAY_NAMES, published.TABLE_4_GAINS_PERCENT, model.table_4(), strict=True)
    figures = [
        Figure(name, "%", told, row.gain_percent, WITHIN_GAIN_PERCENT, remark=_gain_remark(told, row))
        for name, told, row in rows
    ]
    printed = sum(published.TABLE_4_GAINS_PERCENT) / len(figures)
    ours = sum(figure.ours for figure in figures) / len(figures)
    mean = Figure(
        "mean of the twelve printed gains", "%", published.MEAN_GAIN_PERCENT, printed, 0.01, 3,
        basis=Basis.PRINTED,
    )  # fmt: skip
    return Group(
        "Table 4, gains",
        "Ten-degree steps at the best instants, the day's ideal tilt, turbidity 3.000, 6 h to 18 h; nothing "
        "is tuned to the month.",
        (*figures, mean, Figure("mean of the twelve computed gains", "%", None, ours)),
    )


def _gain_remark(told: float, row: DayGain) -> str:
    if abs(told - row.gain_percent) <= WITHIN_GAIN_PERCENT:
        return ""
    return f"It takes a turbidity of {turbidity_for(row.day_of_year, told):.2f}; clean dry air has 1."


def turbidity_for(day_of_year: int, wanted_percent: float) -> float:
    """Return the turbidity at which the model gives a gain on a day; the gain falls as turbidity grows."""
    low, high = 0.0, MOST_TURBIDITY
    while high - low > TURBIDITY_WITHIN:
        middle = (low + high) / 2.0
        low, high = (middle, high) if _gain(day_of_year, middle) > wanted_percent else (low, middle)
    return (low + high) / 2.0


def _gain(day_of_year: int, turbidity: float) -> float:
    """Return the gain of Table 4's way of tracking on a day of a given turbidity, percent."""
    sun_deg = declination_deg(day_of_year)
    counted, whole = (
        clear_day(model.LATITUDE_DEG, day_of_year, sun_deg, turbidity=turbidity, whole=all_day)
        for all_day in (False, True)
    )
    steps = Steps(midpoint_h(TABLE_3_ANGLES_DEG), TABLE_3_ANGLES_DEG, model.LATITUDE_DEG - sun_deg)
    tracked_wh = PER_WHM2 * stepped_whm2(counted, steps)
    return gain_percent(tracked_wh, PER_WHM2 * fixed_whm2(whole, model.LATITUDE_DEG))


def _errata() -> tuple[Erratum, ...]:
    cooper, shifted = (from_spa(PUBLISHED[one].many) for one in (Algorithm.COOPER_EOT, Algorithm.ALEXANDRU))
    whole = model.paper_day(whole=True)
    flat_wh = PER_WHM2 * fixed_whm2(whole, 0.0)
    fixed_wh = PER_WHM2 * fixed_whm2(whole, model.LATITUDE_DEG)
    return (
        Erratum(
            "eq 7", "cos δ′, sin δ′ of the tilt δ′", "cos (φ − δ′), sin (φ − δ′): the normal's declination",
            effect("the fixed panel becomes a horizontal one: ", Measured(flat_wh, 5), " Wh instead of ",
                   Measured(fixed_wh, 5), " Wh"),
        ),
        Erratum(
            "eq 8", "N − 80", "N − 81, as Cooper has 284 + N",
            effect(*worse(shifted, cooper), ", both with equation of time"),
        ),
        Erratum(
            "section 2", "travel 22.05° to 68.95°", "22.20° to 69.10° for φ = 45.65°",
            effect("at the winter solstice the actuator lacks ", Measured(beyond_stroke_mm(), 2), " mm"),
        ),
        Erratum(
            "figure 24", "elevation actuator at zero on 21 June", "out by what 22.20° asks",
            effect(Measured(solstice_stroke_mm(), 2), " mm"),
        ),
        Erratum("section 2", "βe = ∠DEH, βd = ∠ABG", "τe and τd: transmission angles", NAME),
        Erratum("section 4", "TI = TII + tIII", "TIII = TII + tIII", NAME),
        Erratum("section 4", "sunrise 4.26 h", "4.24 h", _sunrise()),
        Erratum("table 3", "step X at 14.59 h", "14.58 h, 24 less 9.42", _tenth_step()),
        Erratum("section 2", "figures 4a and 7a referred to", "5a and 8a", REFERENCE),
        Erratum("section 3", "GK1, GKI and FBS by turns", "one name each", NAME),
        Erratum("section 4", "Melis", "Meliss", NAME),
    )  # fmt: skip


def _sunrise() -> Effect:
    rise_h, _ = daylight_h(model.LATITUDE_DEG, declination_deg(model.SOLSTICE))
    return effect("sunrise ", Measured(60.0 * abs(published.SUNRISE_H - rise_h), 2), " min off")


def _tenth_step() -> Effect:
    """Return how far the time of step X is from its morning's mirror."""
    step = NUMERALS.index("X")
    off_h = TABLE_3_STARTS_H[step] - (24.0 - TABLE_3_STARTS_H[len(NUMERALS) - 1 - step])
    return effect("the step ", Measured(3600.0 * off_h, 2), " s late")


GAPS = (
    Gap(
        "Continuous tracking, 2003.71 Wh",
        "The hours it counts are not printed; no turbidity gives it together with the other two energies.",
    ),
    Gap("Gains of the winter months", "See table 4's gains: model and paper stand side by side."),
    Gap("Energy of the drives, 11.53 Wh", "From a co-simulation whose masses and friction are not printed."),
    Gap("Motor forces, RMS 17.55 N and 11.82 N, and the gains of the controllers", "As above."),
    Gap("Table 1", "Gains that other authors found, each at a place, on days and in a light of its own."),
    Gap("Table 2", "It names the design variables and prints no values."),
    Gap("Figures 6, 9, 21 and 25 to 28", "Curves without printed values."),
)  # fmt: skip
