"""A survey of accuracy as a table of text."""

from app.sun.accuracy import Sight, Survey
from app.sun.accuracy_words import title
from app.sun.algorithms import PUBLISHED

HEAD = (
    f"{'algorithm':<20}{'expected':>9}{'max':>9}{'rms':>9}{'seen, max':>11}{'seen, rms':>11}{'no refr.':>10}"
)


def table(survey: Survey) -> str:
    """Return a line for every algorithm, with the greatest and the root mean square separation."""
    return "\n".join([title(survey), "", HEAD, *_lines(survey), "", *NOTES])


NOTES = (
    "max, rms: true sun against true sun. seen: both with refraction.",
    "no refr.: greatest separation if the true sun is taken for the seen one.",
)


def _lines(survey: Survey) -> list[str]:
    lines = []
    for error in survey.errors:
        true, seen = error.spreads[Sight.TRUE], error.spreads[Sight.APPARENT]
        lines.append(
            f"{error.algorithm.value:<20}{PUBLISHED[error.algorithm].max_deg:>9g}"
            f"{true.max_deg:>9.4f}{true.rms_deg:>9.4f}{seen.max_deg:>11.4f}{seen.rms_deg:>11.4f}"
            f"{error.spreads[Sight.UNREFRACTED].max_deg:>10.4f}"
        )
    return lines
