"""Curves that go on in the browser have the same numbers at their axes as the drawings of the server."""

from datetime import UTC, datetime
from typing import Any

import pytest

from app.web.charts.axis import angle_step, number_step, time_step_s, times, within
from tests.browser.conftest import Opened

SPANS = [0.003, 2.4, 37.0, 180.0, 359.9, 1013.0, 86_400.0]
TIMES = [7.0, 45.0, 600.0, 3600.0, 8 * 3600.0, 86_400.0, 3 * 86_400.0, 7 * 86_400.0, 30 * 86_400.0]
ROOMS = [2, 5, 8, 13]
ENDS = [(-21.3, 67.0), (0.0, 360.0), (-90.0, 90.0), (179.2, 181.7), (0.0, 0.031), (4.0, 4.0)]
MOMENTS = [datetime(2026, 3, 28, 20, 7, tzinfo=UTC), datetime(2026, 10, 24, 20, tzinfo=UTC)]
"""The evenings before the clocks of Europe change."""
ZONES = ["UTC", "Europe/Istanbul", "Europe/Berlin", "Asia/Kolkata", "America/St_Johns"]
ASKED = """async ({ spans, times, rooms, ends, moments, zones }) => {
  const page = document.querySelector('script[src*="js/page.js"]').src;
  const axis = await import(page.replace("page.js", "chart_axis.js"));
  const over = (values, work) => values.flatMap(value => rooms.map(most => work(value, most)));
  const spanned = times.slice(2, 7);
  const between = (at, zone) => over(spanned, (span, most) => axis.times(at, at + span, most, zone));
  return {
    numbers: over(spans, axis.numberStep),
    angles: over(spans, axis.angleStep),
    times: over(times, axis.timeStepS),
    within: over(ends, ([low, high], most) => axis.within(low, high, most)),
    round: over(ends, ([low, high], most) => axis.within(low, high, most, axis.angleStep)),
    moments: moments.flatMap(at => zones.flatMap(zone => between(at, zone))),
    places: [-10, 40, 90].map(axis.scaleOf("-10 90 300 100").at),
    words: [[1774735200, 86400], [1774742400, 172800], [1774738800, 172800], [1774735205, 8]]
      .map(([at, span]) => axis.timeAt(at, "UTC", span)),
  };
}"""


def flat(found: list[Any]) -> list[float]:
    return [value for one in found for value in (one if isinstance(one, list | tuple) else [one])]


def test_scripts_and_server_have_the_same_axis(opened: Opened) -> None:
    page = opened("/")
    starts = [at.timestamp() for at in MOMENTS]
    asked = {"spans": SPANS, "times": TIMES, "rooms": ROOMS, "ends": ENDS, "moments": starts, "zones": ZONES}
    told = page.evaluate(ASKED, asked)
    expected = {
        "numbers": [number_step(span, most) for span in SPANS for most in ROOMS],
        "angles": [angle_step(span, most) for span in SPANS for most in ROOMS],
        "times": [time_step_s(span, most) for span in TIMES for most in ROOMS],
        "within": [within(*ends, most) for ends in ENDS for most in ROOMS],
        "round": [within(*ends, most, angle_step) for ends in ENDS for most in ROOMS],
        "moments": [
            times(at, at + span, most, zone)
            for at in starts
            for zone in ZONES
            for span in TIMES[2:7]
            for most in ROOMS
        ],
    }
    for name, values in expected.items():
        assert [len(flat([one])) for one in told[name]] == [len(flat([one])) for one in values], name
        assert flat(told[name]) == pytest.approx(flat(values), abs=1e-9), name
    assert told["places"] == [300, 200, 100]
    assert told["words"] == ["22:00", "03-29", "23:00", "22:00:05"]
