"""What is typed about the site's weather, read into the machine's words and back."""

from typing import Any

from app.base.message import N_, say, with_format
from app.tracker.memory.memory import MetStation
from app.tracker.values.typed_numbers import written
from app.tracker.weather.simulated_weather import MOST_SEED, SPANS, Scenario, SimulatedStation
from app.tracker.weather.weather_windows import LIMITS, WeatherWindows
from app.web.shell.forms import Typed, Unreadable

STATION_NAMES = ("host", "port", "unit")
SIMULATION_NAMES = ("scenario", "seed", *SPANS)
WINDOW_NAMES = tuple(LIMITS)
SCENARIOS = (
    (Scenario.MANUAL.value, N_("Manual: the values below")),
    (Scenario.CALM.value, N_("A calm day")),
    (Scenario.STORM.value, N_("A storm that comes and goes, 25 min")),
    (Scenario.SNOWFALL.value, N_("A snowfall that slides off, 22 min")),
    (Scenario.CLOUDS.value, N_("Clouds, then heavy overcast, 56 min")),
)
USUAL = WeatherWindows()
UNITS = {"percent": "%", "degrees from north": "°", "degrees Celsius": "°C"}


def station_texts(station: MetStation | None) -> Typed:
    """Return the form of the station that is read."""
    if station is None:
        return Typed({"host": "", "port": "502", "unit": "1"})
    return Typed({"host": station.host, "port": str(station.port), "unit": str(station.unit)})


def simulation_texts(station: SimulatedStation | None) -> Typed:
    """Return the form of the made-up weather; light is empty where the sky is clear."""
    shown = station or SimulatedStation()
    values = {name: getattr(shown, name) for name in SPANS}
    texts = {name: "" if value is None else written(value, SPANS[name][2]) for name, value in values.items()}
    return Typed({"scenario": shown.scenario.value, "seed": str(shown.seed), **texts})


def window_texts(windows: WeatherWindows | None) -> Typed:
    """Return the form of windows and ages."""
    shown = windows or USUAL
    return Typed({name: written(getattr(shown, name), high) for name, (_, _, high) in LIMITS.items()})


def window_hints() -> dict[str, str]:
    """Return range and usual value of every window and age."""
    return {
        name: say(
            "{low} to {high}, usual {usual}.",
            low=with_format(low, "g"),
            high=with_format(high, "g"),
            usual=with_format(getattr(USUAL, name), "g"),
        )
        for name, (_, low, high) in LIMITS.items()
    }


def read_station(typed: Typed) -> MetStation | None:
    """Return the typed station, None for no host."""
    if not (host := typed.text("host")):
        return None
    port = typed.whole("port", N_("Port"), 1, 65535)
    unit = typed.whole("unit", N_("Unit"), 0, 255)
    return None if typed.errors else MetStation(host, port, unit)


def read_simulation(typed: Typed) -> SimulatedStation | None:
    """Return the typed made-up weather, None while anything in it is wrong."""
    scenario = typed.read("scenario", _scenario, Scenario.MANUAL)
    seed = typed.whole("seed", N_("Seed"), 0, MOST_SEED)
    values: dict[str, Any] = {
        name: typed.number(name, title, low, high, UNITS.get(unit, unit))
        for name, (title, low, high, unit) in SPANS.items()
        if name != "irradiance_wm2" or typed.texts[name].strip()
    }
    return None if typed.errors else SimulatedStation(scenario, seed, **values)


def read_windows(typed: Typed) -> WeatherWindows | None:
    """Return the typed windows and ages, None while anything in them is wrong."""
    values = {name: typed.number(name, title, low, high, "s") for name, (title, low, high) in LIMITS.items()}
    return None if typed.errors else WeatherWindows(**values)


def _scenario(text: str) -> Scenario:
    if text not in list(Scenario):
        raise Unreadable(N_("Scenario: choose one from the list."))
    return Scenario(text)
