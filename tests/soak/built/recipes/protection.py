"""A protection: what its recipe changes and adds, and the proof that it works."""

MODULE = '''"""Gusts in which a panel is not stowed: it holds its position until they are over."""

from dataclasses import dataclass
from datetime import datetime

from app.tracker.settings.protections import GustProtection


@dataclass(frozen=True, slots=True)
class GustHold:
    """Since when it holds, steady time; None: it does not."""

    since: datetime | None = None


STILL = GustHold()


def step(state: GustHold, limits: GustProtection, gust_mps: float | None, now: datetime) -> GustHold:
    """Return the state after one look at the gust, m/s; one that is not known changes nothing."""
    if not limits.enabled:
        return STILL
    if gust_mps is None:
        return state
    return GustHold(state.since or now) if gust_mps >= limits.hold_mps else STILL
'''
LIMITS = '''@dataclass(frozen=True, slots=True)
class GustProtection:
    """When gusts hold the panel where it is."""

    enabled: Enabled = True
    hold_mps: Annotated[
        float, Ge(1), Le(60), Setting(N_("Hold threshold"), "m/s", help=N_("Highest wind speed over 3 s."))
    ] = 12.0

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class StowPlace:
'''
REASON = """        case Protection.GUST_HOLD:
            text = say("{name} holds: there are gusts.", name=name)
            return Reason("gusts", text, N_("Tracking continues automatically after the gusts."))
        case Protection.WAIT:
"""
NEW = {"app/tracker/protections/gust_hold.py": MODULE}
EDITS = {
    "app/tracker/protections/words.py": (
        ('    WAIT = "wait"\n', '    GUST_HOLD = "gust_hold"\n    WAIT = "wait"\n'),
    ),
    "app/tracker/settings/protections.py": (
        ("@dataclass(frozen=True, slots=True)\nclass StowPlace:\n", LIMITS),
        (
            "    stows: Annotated[Stows",
            '    gusts: Annotated[GustProtection, Setting(N_("Gusts"), help=N_("Held in gusts."))] = (\n'
            "        GustProtection()\n    )\n    stows: Annotated[Stows",
        ),
    ),
    "app/tracker/protections/priority.py": (
        ("*, night: bool", "*, night: bool, gusty: bool"),
        (
            "    if before in WAITS_FOR_LIGHT",
            "    if gusty:\n        return Protection.GUST_HOLD\n    if before in WAITS_FOR_LIGHT",
        ),
    ),
    "app/tracker/protections/guarding.py": (
        ("import low_light, sensor", "import gust_hold, low_light, sensor"),
        ("HOLDS = (", "HOLDS = (Protection.GUST_HOLD, "),
        (
            "    held: Quantity | None = None\n",
            "    held: Quantity | None = None\n    gusts: gust_hold.GustHold = gust_hold.STILL\n",
        ),
        (
            "    kind = classify(state.kind, blown, loaded, dark, night=night)\n",
            "    gusts = gust_hold.step(state.gusts, config.gusts, seen.wind.good, now)\n"
            "    gusty = gusts.since is not None\n"
            "    kind = classify(state.kind, blown, loaded, dark, night=night, gusty=gusty)\n",
        ),
        ("kind, since, held)\n", "kind, since, held, gusts)\n"),
    ),
    "app/tracker/supervision/weather_protection.py": (
        ("DEMANDS = (", "DEMANDS = (Protection.GUST_HOLD, "),
        ("        case Protection.WAIT:\n", REASON),
    ),
}
PROOF = """

from app.tracker.commands.commands import Track
from app.tracker.protections.words import Protection
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.tracker.plant import READY, Plant

plant = Plant(READY).blow().forward(1)
plant.ask(Track())
plant.forward(60)
assert plant.activity is ActivityName.TRACKING and plant.snapshot.protection is None
plant.blow(13.0).forward(5)
held, azimuth_deg = plant.snapshot, plant.azimuth_deg
assert held.protection.protection is Protection.GUST_HOLD, held.protection
assert [reason.code for reason in held.waiting] == ["gusts"], held.waiting
plant.forward(300)
assert plant.azimuth_deg == azimuth_deg, "the panel turns in gusts"
plant.blow(18.0).forward(1)
assert plant.snapshot.protection.protection is Protection.WIND_STOW, "strong wind has priority"
plant.blow().forward(700)
assert plant.snapshot.protection is None, plant.snapshot.protection
assert plant.azimuth_deg != azimuth_deg, "tracking does not continue"
kinds = [event.kind for event in plant.events]
assert kinds.count(EventKind.PROTECTION_BEGAN) == kinds.count(EventKind.PROTECTION_ENDED) == 2, kinds


async def seen():
    async with serving(fake_app(FakeMachine(), FakeReader())) as client:
        page = (await client.get("/trackers/T1/protections")).text
        assert 'name="gusts_hold_mps"' in page and "<h2>Gusts</h2>" in page, "the form"
        path = "/api/v1/trackers/T1"
        wrong = await client.patch(path, json={"protection": {"gusts": {"hold_mps": 61}}})
        assert wrong.status_code == 422 and "between 1 and 60" in wrong.text, wrong.text
"""
