"""What a study was asked, in the words of its report."""

from app.base.message import N_, Message, say, with_format
from app.studies.request import CLEAR_SKIES, Fidelity, LightModel, StudyRequest
from app.studies.result import StudyResult
from app.sun.position import Location
from app.web.features.studies.studies import TRANSPOSITIONS
from app.web.shell.formats import words

PLACES = {
    (True, True): N_("{latitude_deg}° north, {longitude_deg}° east, {altitude_m} m"),
    (True, False): N_("{latitude_deg}° north, {longitude_deg}° west, {altitude_m} m"),
    (False, True): N_("{latitude_deg}° south, {longitude_deg}° east, {altitude_m} m"),
    (False, False): N_("{latitude_deg}° south, {longitude_deg}° west, {altitude_m} m"),
}
"""How a place is told, by whether it lies in the north, and in the east."""


def settings(asked: StudyRequest, result: StudyResult | None) -> tuple[tuple[str, str], ...]:
    """Return the label and the text of each setting; a finished study has the place and step it used."""
    return (
        (N_("Location"), _place(result.location if result else asked.location)),
        (N_("Days"), _days(asked, result.step_min if result else asked.step_min)),
        (N_("Irradiance"), _irradiance(asked)),
        (
            N_("Fixed panel"),
            _numbers(
                N_("azimuth {azimuth_deg}°, elevation {elevation_deg}°"),
                azimuth_deg=asked.held.azimuth_deg,
                elevation_deg=asked.held.elevation_deg,
            ),
        ),
        (
            N_("Panels"),
            _numbers(
                N_("{power_w} W, losses {losses_percent} %, {value} %/K"),
                power_w=asked.module.power_w,
                losses_percent=asked.module.losses_percent,
                value=100 * asked.module.per_kelvin,
            ),
        ),
        (
            N_("Drives"),
            _numbers(
                N_("{degree_wh} Wh/°, {start_wh} Wh per start, {standby_w} W standby"),
                degree_wh=asked.costs.degree_wh,
                start_wh=asked.costs.start_wh,
                standby_w=asked.costs.standby_w,
            ),
        ),
        (
            N_("Strategies"),
            _numbers(
                N_("deadband {deadband_deg}°, interval {interval_min} min"),
                deadband_deg=asked.deadband_deg,
                interval_min=asked.interval_min,
            ),
        ),
    )


def _numbers(template: str, **values: float) -> Message:
    return say(template, **{name: with_format(value, "g") for name, value in values.items()})


def _place(place: Location) -> Message:
    return say(
        PLACES[place.latitude_deg >= 0.0, place.longitude_deg >= 0.0],
        latitude_deg=with_format(abs(place.latitude_deg), ".4f"),
        longitude_deg=with_format(abs(place.longitude_deg), ".4f"),
        altitude_m=with_format(place.altitude_m, "g"),
    )


def _days(asked: StudyRequest, step_min: float) -> Message:
    fidelity = N_("ideal drives") if asked.fidelity is Fidelity.IDEAL else N_("controller simulation")
    return say(
        "{span}, {on}, a value every {step} min, {fidelity}",
        span=words(asked.span),
        on=asked.on,
        step=step_min,
        fidelity=fidelity,
    )


def _irradiance(asked: StudyRequest) -> Message:
    light = asked.weather_file if asked.light is LightModel.WEATHER else CLEAR_SKIES[asked.light]
    return say(
        "{light}; sky model {sky}; albedo {albedo}",
        light=light,
        sky=dict(TRANSPOSITIONS)[asked.around.transposition],
        albedo=with_format(asked.around.albedo, "g"),
    )
