"""Every page and every call answers alike whatever the site's clock shows: no page needs the sun."""

import asyncio
import re
from datetime import UTC, datetime

import pytest

from app.base.clock import VirtualClock
from tests.amount import amount
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import BY_ITSELF, FaultResult
from tests.patience import PATIENCE_S
from tests.web.route_table import ROUTES

TODAY = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
UNKNOWN = datetime(2206, 6, 1, tzinfo=UTC)
CLOCKS = amount([UNKNOWN], [datetime(2099, 12, 31, 23, 59, 59, tzinfo=UTC), UNKNOWN])
NOW = "/api/v1/sun"
"""Tells where the sun stands now, and is refused with a sentence while that is not known."""
LEFT_OUT = {"/api/v1/stream", "/api/v1/papers", "/api/v1/sun/accuracy"}
"""What never ends, and what takes long and does not look at the clock."""
SLOW = {"/trackers/T1/strategy/day", "/api/v1/studies/comparison"}
"""Simulated for a second: asked in the year that is known least, in the soak in all of them."""
PATHS = sorted(
    re.sub(r"\{(\w+)(?::\w+)?\}", lambda found: "T1" if found[1] == "tracker_id" else "1", path)
    for method, _, path in (key.partition(" ") for key in ROUTES)
    if method == "GET"
)


async def answers(at: datetime) -> dict[str, int]:
    """Return the status of every page and call while the site's clock shows this."""
    left_out = LEFT_OUT | amount(SLOW if at != UNKNOWN else set(), set())
    async with serving(fake_app(FakeMachine(VirtualClock(at)))) as browser:
        return {
            path: (await asyncio.wait_for(browser.get(path), PATIENCE_S)).status_code
            for path in PATHS
            if path not in left_out
        }


@pytest.mark.fault(102)
async def test_no_page_is_lost_to_a_clock_that_is_wrong(fault: FaultResult) -> None:
    expected = await answers(TODAY)
    assert set(expected.values()) <= {200, 303, 307, 404, 422}
    assert expected.pop(NOW) == 200
    for at in CLOCKS:
        found = await answers(at)
        assert found.pop(NOW) == (200 if 1901 <= at.year <= 2099 else 422)
        assert found == expected | dict.fromkeys(SLOW & found.keys(), 200), at
    fault.prevented("a page that shows today's sun shows the nearest year with a known sun")
    fault.recovers(BY_ITSELF)
