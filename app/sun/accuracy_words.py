"""What a survey of accuracy measured, in a sentence."""

from app.base.message import Message, say, with_format
from app.sun.accuracy import Survey


def title(survey: Survey) -> Message:
    """Return in a sentence what was measured."""
    asked, at = survey.question, survey.question.location
    low, high = asked.latitudes
    if at is None:
        return say(
            "Separation from NREL SPA, degrees: latitude {low} to {high}, {from_year} to "
            "{to_year}, {sun_up} of {samples} instants with the sun up.",
            low=with_format(low, "g"),
            high=with_format(high, "g"),
            from_year=asked.from_year,
            to_year=asked.to_year,
            sun_up=with_format(survey.sun_up, ","),
            samples=with_format(asked.samples, ","),
        )
    return say(
        "Separation from NREL SPA, degrees: latitude {latitude_deg}, longitude "
        "{longitude_deg}, {from_year} to {to_year}, {sun_up} of {samples} instants with the "
        "sun up.",
        latitude_deg=with_format(at.latitude_deg, "g"),
        longitude_deg=with_format(at.longitude_deg, "g"),
        from_year=asked.from_year,
        to_year=asked.to_year,
        sun_up=with_format(survey.sun_up, ","),
        samples=with_format(asked.samples, ","),
    )
