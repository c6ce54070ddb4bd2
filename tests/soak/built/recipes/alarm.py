"""An alarm: what its recipe changes and adds, and the proof that it works."""

ENTRY = """ENTRIES = (
    Entry(
        "area_not_clear", 3, Group.MOTION, N_("Area not confirmed clear"),
        N_("The panel does not move in service mode."),
        N_("Check the area, then press Confirm area clear."),
    ),
"""
GUIDE = "docs/operate/operators-guide.md"
BEFORE = '| <a id="alarm-limit_switch"></a>'
ROW = (
    '| <a id="alarm-area_not_clear"></a>Area not confirmed clear (`area_not_clear`) | 3 '
    "| The panel does not move in service mode. | Check the area, then press Confirm area clear. |\n"
)
EDITS = {
    "app/alarms/catalogue.py": (("ENTRIES = (\n", ENTRY),),
    GUIDE: ((BEFORE, ROW + BEFORE),),
}
NEW: dict[str, str] = {}
PROOF = """
from dataclasses import replace
from pathlib import Path

from app.alarms.conditions import SiteHealth, of_tracker
from app.tracker.values.reason import Reason
from app.alarms.catalogue import CATALOGUE

machine = FakeMachine()
calm = machine.latest().trackers[0]
said = Reason("area_not_clear", "The confirmation has expired.", "Confirm it again.")
found = of_tracker(replace(calm, notices=(said,)), SiteHealth(), frozenset())
assert [one.code for one in found] == ["area_not_clear"], found
guide = Path("docs/operate/operators-guide.md").read_text()
row = next(one for one in guide.splitlines() if "alarm-area_not_clear" in one)
entry = CATALOGUE["area_not_clear"]
assert all(str(one) in row for one in (entry.title, entry.consequence, entry.do)), row


async def seen():
    async with serving(fake_app(machine, FakeReader())) as client:
        page = (await client.get("/alarms/guide")).text
        assert "Area not confirmed clear" in page, "the page of all alarms"
        found = (await client.get("/search?q=area+not+confirmed")).text
        assert "Area not confirmed clear" in found, "the search"
"""
