"""Step programs that come with the product."""

from app.base.message import N_
from app.tracker.settings.stepped import StepProgram, program_of

ALEXANDRU_TABLE_3 = program_of(
    N_("Alexandru 2024, Table 3"),
    (7.88, 8.63, 9.42, 10.19, 10.93, 11.56, 12.44, 13.07, 13.81, 14.58, 15.37, 16.12),
    (-60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0),
    second_deg=23.45,
)
"""Twelve steps of 10 degrees about the diurnal axis for the summer solstice: C. Alexandru, 2024, Table 3.

Hour angles grow with the time here, so they have the opposite sign; 14.59 in step X is a misprint of 14.58.
A tilt of 22.2 degrees at the paper's latitude of 45.65 is a declination of 23.45 degrees, that of the sun on
this day, at every latitude.
"""

EXAMPLES: dict[str, StepProgram] = {"alexandru-table-3": ALEXANDRU_TABLE_3}
