"""From the optimiser's steps to a program that a tracker runs."""

from app.energy.equatorial import panel_declination_deg
from app.energy.stepping import Steps
from app.tracker.settings.stepped import StepFrame, StepProgram, TimeBase, program_of


def step_program(name: str, steps: Steps, latitude_deg: float) -> StepProgram:
    """Return the steps as directions of the sky by hour angle and declination, in solar time.

    A program's hour angle is positive in the afternoon, the paper's in the morning.
    """
    hour_angles = [0.0 - angle_deg for angle_deg in steps.angles_deg]
    declination_deg = panel_declination_deg(latitude_deg, steps.tilt_deg)
    return program_of(
        name,
        steps.starts_h,
        hour_angles,
        second_deg=declination_deg,
        frame=StepFrame.EQUATOR,
        time_base=TimeBase.SOLAR,
    )
