"""The best step programs as a table in a file."""

import csv
from io import StringIO

from app.studies.jobs import ProgramAnswer

HEADS = (
    "steps",
    "electric_wh",
    "further_wh",
    "drives_wh",
    "net_wh",
    "net_gain_percent",
    "tilt_deg",
    "travel_deg",
)


def programs_csv(answer: ProgramAnswer) -> str:
    """Return a line for every number of steps as CSV; the gain is over the fixed panel, empty without one."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADS)
    for row in answer.rows:
        gain = f"{100 * (row.net_wh / answer.fixed_wh - 1):.4f}" if answer.fixed_wh > 0 else ""
        paid = (row.electric_wh, row.further_wh, row.drives_wh, row.net_wh)
        turned = (row.tilt_deg, row.travel_deg)
        writer.writerow([row.steps, *map(_plain, paid), gain, *map(_plain, turned)])
    return text.getvalue()


def _plain(value: float) -> str:
    return f"{value:.4f}"
