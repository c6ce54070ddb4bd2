"""What a survey of accuracy measured, in a sentence."""

from app.sun.accuracy import Survey


def title(survey: Survey) -> str:
    """Return in a sentence what was measured."""
    asked, at = survey.question, survey.question.location
    low, high = asked.latitudes
    if at is None:
        return (
            f"Separation from NREL SPA, degrees: latitude {low:g} to {high:g}, {asked.from_year} to "
            f"{asked.to_year}, {survey.sun_up:,} of {asked.samples:,} instants with the sun up."
        )
    return (
        f"Separation from NREL SPA, degrees: latitude {at.latitude_deg:g}, longitude {at.longitude_deg:g}, "
        f"{asked.from_year} to {asked.to_year}, {survey.sun_up:,} of {asked.samples:,} instants with the "
        "sun up."
    )
