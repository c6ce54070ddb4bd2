"""A weather station whose first report is impossible, in every way that SunSpec model 307 allows."""

import json
from pathlib import Path

import pytest

from app.base.twins import Twins
from app.drives.connections.met_station import POINTS, weather_of
from app.link.messages import SetMetStation
from app.site.site import SiteOptions
from app.site.weather.kept_weather import ROOM
from app.tracker.commands.commands import Stop
from app.tracker.memory.memory import MetStation, SiteState
from app.tracker.state.snapshot import ActivityName, SiteSnapshot
from app.tracker.weather.weather import RANGES, Weather
from tests.fault_result import BY_ITSELF, FaultResult
from tests.golden.table import rows
from tests.site.plant import Begun, Plant, make_plant
from tests.site.tracking_field import homed

WORDS = ("temperature", "humidity", "pressure", "wind", "direction", "rain", "snow")
UNKNOWN, SENTINELS = 0x8000, (0, 1, 0x7FFF, 0x8001, 0xFFFE, 0xFFFF)
GOOD = [215, 45, 1013, 4, 210, UNKNOWN, UNKNOWN]
HOST = MetStation("127.0.0.1", 1502, 1)
ROWS = rows("world/stations.csv")


class Station:
    """A station that answers with these words of model 307."""

    def __init__(self, words: list[int]) -> None:
        self.words = words

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        return weather_of(self.words)

    async def close(self) -> None:
        pass


def ends(name: str, scale: float) -> set[int]:
    """Return the words at the ends of what is possible, and just beyond them."""
    _, low, high, _ = RANGES[name]
    counts = (round(low / scale), round(high / scale))
    return {(count + step) & 0xFFFF for count in counts for step in (-1, 0, 1)}


def kept(value: object, at: str = "2027-06-21T09:00:00Z") -> dict[str, object]:
    return {"value": value, "at": at, "source": "mast"}


def plant_of(words: list[int], folder: Path, state: SiteState | None = None) -> Plant:
    return make_plant(options=options_of(words, folder), state=state)


def options_of(words: list[int], folder: Path) -> SiteOptions:
    return SiteOptions(make_station=lambda _: Station(words), weather_file=folder / "weather")


async def first_report(
    words: list[int], folder: Path, state: SiteState | None = None
) -> tuple[SiteSnapshot, SiteState]:
    """Return what a site tells and stores after the first report, which left it alive."""
    plant = plant_of(words, folder, state)
    await plant.start()
    await plant.ask(SetMetStation(HOST))
    await plant.forward(seconds=1.5)
    assert plant.site.alive, words
    told = await plant.ask(Stop())
    await plant.close()
    return told, plant.site.model.state


@pytest.mark.parametrize("row", ROWS, ids=[row["what"] for row in ROWS])
async def test_what_is_possible_is_taken_and_the_rest_is_marked(row: dict[str, str], tmp_path: Path) -> None:
    words = [int(row[name]) for name in WORDS]
    seen, state = await first_report(words, tmp_path)
    await first_report(words, tmp_path, state)
    readings = {
        name: float(value) for name, _, value in (one.partition("=") for one in row["readings"].split())
    }
    impossible = set(row["impossible"].split())
    if not readings and not impossible:
        assert seen.weather is None or seen.weather.readings == Weather()
        return
    assert seen.weather is not None
    assert seen.weather.readings == Weather(**readings)
    marked = {name: one for name, one in seen.weather.quantities.items() if one.quality == "impossible"}
    assert set(marked) == impossible
    assert {one.value for one in marked.values()} <= {None}, "no number stands for what was impossible"


@pytest.mark.parametrize("place", range(len(POINTS)), ids=[name for name, _ in POINTS])
async def test_no_word_of_any_point_ends_the_controller(place: int, tmp_path: Path) -> None:
    """Each is the first report of a site, which starts again with what the last one kept."""
    state = None
    for word in sorted({*SENTINELS, *ends(*POINTS[place])}):
        _, state = await first_report([*GOOD[:place], word, *GOOD[place + 1 :]], tmp_path, state)


@pytest.mark.fault(98)
async def test_a_tracker_goes_on_tracking_beside_an_impossible_pressure(
    tmp_path: Path, fault: FaultResult, begun: Begun
) -> None:
    plant = await begun(
        homed(tracks=True, options=options_of([215, 45, 0, 4, 210, UNKNOWN, UNKNOWN], tmp_path))
    )
    await plant.ask(SetMetStation(HOST))
    await plant.forward(seconds=3)
    assert plant.site.alive
    assert plant.tracker().activity is ActivityName.TRACKING
    fault.prevented("a value that is impossible is marked, and nothing else follows")
    fault.shows_nothing("the value's quality is *impossible*, and there is no number")
    fault.recovers(BY_ITSELF)


BAD_KEPT = {
    "an impossible pressure": {"quantities": {"pressure_hpa": kept(0.0)}},
    "a quantity that nobody knows": {"quantities": {"colour": kept(3.0)}},
    "an impossible wind": {"winds": [kept(-4.0)], "gust_mps": 1e300, "mean_mps": -1.0},
    "nothing at all": {},
    "a year 9999": {"reported_at": "9999-12-31T23:59:59Z"},
    "a year 1": {"quantities": {"wind_mps": kept(4.0, "0001-01-01T00:00:00Z")}},
    "no time zone": {"reported_at": "2027-06-21T09:00:00"},
    "a text for a number": {"quantities": {"wind_mps": kept("fast")}},
    "years to come": {"reported_at": "2099-06-21T09:00:00Z", "winds": [kept(4.0, "2099-06-21T09:00:00Z")]},
}


@pytest.mark.fault(98)
@pytest.mark.parametrize("changes", BAD_KEPT.values(), ids=BAD_KEPT)
async def test_kept_weather_that_is_impossible_is_set_aside(
    changes: dict[str, object], tmp_path: Path, fault: FaultResult, begun: Begun
) -> None:
    whole = {"reported_at": "2027-06-21T09:00:00Z", "source": "mast", **changes}
    Twins(tmp_path / "weather", ROOM).write(0, json.dumps(whole).encode())
    plant = await begun(plant_of(GOOD, tmp_path))
    await plant.forward(seconds=1)
    assert plant.site.alive
    weather = (await plant.ask(Stop())).weather
    assert weather is None or weather.readings == Weather() or weather.readings.wind_mps == 4.0
    fault.prevented("what is kept is judged again when it is read")
    fault.shows_nothing("the log names what was set aside")
    fault.recovers(BY_ITSELF)
