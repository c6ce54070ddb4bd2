"""The reference trace of the protections of Xia et al. (2015), tick by tick.

`tests/golden/protections_trace.csv` tells every transition of a day of 8,501 looks, one a second, with the
encoder counts and targets at that look (10 counts are a degree, the azimuth counts from south). Its inputs,
as its source tells them: darkness from 1000 to 1899; wind of 17 m/s until 3099 and one gust at 3500; 4.5 kg
of snow for 50 s, 4.0 kg from 5200 to 5399; 5 kg with 17 m/s from 6000 to 6199; the sun sets at 8500. The sun
moves one count in 24 s and 45 s; an axis turns by 20 counts a second once it is off by 10, until it is on.
"""

import csv
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

from app.tracker.protections.guarding import OFF_GUARD, step
from app.tracker.protections.words import Protection
from app.tracker.settings.protections import LightProtection, ProtectionConfig, WindProtection
from app.tracker.weather.weather import Quality, Quantity, Reading, Sensed

TRACE = Path(__file__).parents[2] / "golden" / "protections_trace.csv"
BEGIN = datetime(2026, 6, 21, 6, 0, tzinfo=UTC)
PAPER = ProtectionConfig(
    wind=WindProtection(gust_mps=17.0, mean_mps=60.0), light=LightProtection(hysteresis_wm2=0.0)
)
DEADBAND_COUNTS = 10
COUNTS_A_SECOND = 20
XIA = {Protection.WIND_STOW: "TYPHOON", Protection.LOW_LIGHT_HOLD: "HIBERNATE"}
"""What the paper calls them."""


def _between(t: int, first: int, last: int) -> bool:
    return first <= t <= last


def _wind_mps(t: int) -> float:
    windy = _between(t, 3000, 3099) or t == 3500 or _between(t, 6000, 6199)
    return 17.0 if windy else 16.9


def _snow_kg(t: int) -> float:
    if _between(t, 5000, 5049):
        return 4.5
    if _between(t, 5200, 5399):
        return 4.0
    return 5.0 if _between(t, 6000, 6199) else 0.0


def _sensed(t: int) -> Sensed:
    irradiance_wm2 = 0.0 if _between(t, 1000, 1899) else 500.0
    wind, snow, light = (
        Reading(value, Quality.GOOD, 0.0, "trace") for value in (_wind_mps(t), _snow_kg(t), irradiance_wm2)
    )
    return Sensed(wind, snow, light)


@dataclass
class _Motor:
    """An axis of the paper: it starts when it is off by 10 counts, and runs until it is off by none."""

    counts: int = 0
    runs: bool = False

    def turn(self, target: int, *, told: bool) -> None:
        self.runs = told and (self.runs or abs(target - self.counts) >= DEADBAND_COUNTS)
        if self.runs:
            away = target - self.counts
            self.counts += max(-COUNTS_A_SECOND, min(COUNTS_A_SECOND, away))
            self.runs = self.counts != target


@dataclass
class _Machine:
    """The paper's tracker: which axes may move in a state, and where to."""

    azimuth: _Motor = field(default_factory=_Motor)
    altitude: _Motor = field(default_factory=_Motor)

    def tick(self, t: int, kind: Protection) -> tuple[int, int, int, int]:
        azimuth, altitude = round(-450 + t / 24), round(300 + t / 45)
        altitude = {Protection.WIND_STOW: 900, Protection.SNOW: 0}.get(kind, altitude)
        self.azimuth.turn(azimuth, told=kind is Protection.TRACK)
        moves = (Protection.TRACK, Protection.WIND_STOW, Protection.SNOW)
        self.altitude.turn(altitude, told=kind in moves)
        return self.azimuth.counts, self.altitude.counts, azimuth, altitude


def _transitions() -> list[tuple[str, ...]]:
    """Return the trace that our state machines leave, written as the reference is."""
    state, machine, before = OFF_GUARD, _Machine(), ""
    rows: list[tuple[str, ...]] = []
    for t in range(8501):
        now = BEGIN + timedelta(seconds=t)
        state = step(state, PAPER, _sensed(t), tuple(Quantity), now, night=t >= 8500)
        assert state.kind is not None
        seen = machine.tick(t, state.kind)
        kind = XIA.get(state.kind, state.kind.value.upper())
        if kind != before:
            rows.append((str(t), before, kind, *map(str, seen)))
            before = kind
    return rows


def test_the_reference_trace_is_reproduced_with_every_count() -> None:
    with TRACE.open(newline="") as file:
        reference = [tuple(row) for row in csv.reader(file)][1:]
    assert _transitions() == reference
