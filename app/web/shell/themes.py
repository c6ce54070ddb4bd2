"""Day, sun and night: chosen by hand, or by how high the sun stands."""

from app.tracker.state.snapshot import SiteSnapshot

DAY, SUN, NIGHT, AUTO = "day", "sun", "night", "auto"
THEMES = (DAY, SUN, NIGHT)
CHOICES = (*THEMES, AUTO)
GLARE_ABOVE_DEG = 15.0
NIGHT_BELOW_DEG = -3.0
"""Below 3 degrees under the horizon it is dark outside."""


def choice_of(cookie: str | None) -> str:
    """Return what was chosen; day where nothing was."""
    return cookie if cookie in CHOICES else DAY


def theme_of(choice: str, site: SiteSnapshot | None) -> str:
    """Return the theme to show: what was chosen, or with `auto` what the sun's elevation asks for.

    Where the sun is not known `auto` is the day.
    """
    if choice != AUTO:
        return choice
    if site is None or site.sun is None:
        return DAY
    elevation_deg = site.sun.apparent_elevation_deg
    if elevation_deg < NIGHT_BELOW_DEG:
        return NIGHT
    return SUN if elevation_deg > GLARE_ABOVE_DEG else DAY
