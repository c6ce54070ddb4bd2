"""From what is asked to a study, with the site's own values where none is given."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from app.base.instants import Day
from app.base.message import N_, say, with_format
from app.energy.motion import DriveCosts
from app.energy.plane import Around, Transposition
from app.energy.program import step_program
from app.energy.stepping import Steps
from app.fast.comparison import ClearSky
from app.link.messages import SiteDetail, UnknownTracker
from app.studies.folder import LONGEST_FILE_NAME
from app.studies.jobs import CompareSite, ProgramAnswer, ProgramLight, ProgramQuestion
from app.studies.request import (
    FIRST_YEAR,
    LAST_YEAR,
    Fidelity,
    LightModel,
    Module,
    Span,
    StudyMode,
    StudyRequest,
    StudyStrategy,
)
from app.sun.position import Location
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped
from app.web.api.base import Azimuth, Clean, Elevation, Input

NO_PLACE = N_("Give latitude and longitude, or save the site's location first: step 1 of commissioning.")
HALF_A_PLACE = N_("Give latitude and longitude together, or leave both out for the site's location.")


class Place(Input):
    """Where; left out: the site's location."""

    latitude_deg: float | None = Field(None, ge=-90, le=90, description="North positive.", examples=[45.65])
    longitude_deg: float | None = Field(None, ge=-180, le=180, description="East positive.", examples=[25.6])
    altitude_m: float | None = Field(None, ge=-500, le=9000)

    def location(self, site: SiteDetail) -> Location:
        """Return the place that is given, else the site's."""
        known = site.site.location
        if self.latitude_deg is not None and self.longitude_deg is not None:
            return Location(self.latitude_deg, self.longitude_deg, self.altitude_m or 0.0)
        if self.latitude_deg is not None or self.longitude_deg is not None:
            raise ValueError(HALF_A_PLACE)
        if known is None:
            raise ValueError(NO_PLACE)
        return known if self.altitude_m is None else replace(known, altitude_m=self.altitude_m)


class NewStudy(Place):
    """What to compare; everything but the day has a value if it is left out."""

    date: Day = Field(description="The day, or any day of the year.", examples=["2026-06-21"])
    title: Annotated[str, Clean] = Field("", max_length=120)
    time_zone: str | None = Field(None, max_length=64, description="IANA name; left out: the site's.")
    span: Span = Field(Span.TWELVE_DAYS, description="A day, the 12 representative days, or a year.")
    step_min: int = Field(10, ge=1, le=60, description="Minutes between instants; divides an hour.")
    modes: tuple[StudyMode, ...] = Field(
        (StudyMode.FIXED, StudyMode.AZIMUTH, StudyMode.ELEVATION_LEAST, StudyMode.DUAL), max_length=9
    )
    strategies: tuple[StudyStrategy, ...] = Field((StudyStrategy.DEADBAND,), max_length=4)
    fidelity: Fidelity = Fidelity.IDEAL
    tracker_id: str | None = Field(
        None, max_length=64, description="Whose configuration, and whose step program."
    )
    azimuth_deg: Azimuth | None = Field(None, description="Held azimuth; left out: towards the equator.")
    elevation_deg: Elevation | None = Field(
        None, description="Elevation of the held normal; left out: 90 degrees less the latitude."
    )
    light: LightModel = LightModel.INEICHEN
    weather_file: str | None = Field(
        None, max_length=LONGEST_FILE_NAME, description="Name of an uploaded weather file."
    )
    transposition: Transposition = Transposition.HAY_DAVIES
    albedo: float = Field(0.2, ge=0, le=1)
    power_w: float = Field(
        1000.0, ge=1, le=1e9, description="Power of the panels at 1000 W/m2 and 25 degrees Celsius."
    )
    per_kelvin: float = Field(-0.0035, ge=-0.02, le=0, description="Change of power a kelvin.")
    losses_percent: float = Field(14.0, ge=0, lt=100)
    air_degc: float = Field(20.0, ge=-60, le=60, description="Air, where no weather file says it.")
    wind_mps: float = Field(1.0, ge=0, le=50, description="Wind, where no weather file says it.")
    degree_wh: float = Field(
        0.02, ge=0, le=1e4, description="What the drives take for a degree of travel, Wh."
    )
    start_wh: float = Field(
        0.005, ge=0, le=1e4, description="What the drives take for a start of an axis, Wh."
    )
    standby_w: float = Field(0.5, ge=0, le=1e4, description="What the drives take all day and night, W.")
    deadband_deg: float = Field(1.0, ge=0.05, le=30)
    interval_min: int = Field(20, ge=1, le=240)
    program: StepProgram | None = Field(None, description="Left out: the tracker's own.")
    rows_ratio: float = Field(
        0.0, ge=0, le=1, description="Ground coverage of rows between which single axes backtrack; 0: none."
    )
    range_deg: float = Field(60.0, ge=5, le=180, description="How far single and polar axes turn either way.")
    axis_tilt_deg: float = Field(20.0, ge=0, le=90, description="Of the tilted single axis.")

    def request(self, site: SiteDetail) -> StudyRequest:
        """Return the study; raises `ValueError` with sentences, `UnknownTracker`."""
        location = self.location(site)
        tracker = _tracker(site, self.tracker_id)
        return StudyRequest(
            title=self.title or self._title(),
            location=location,
            time_zone=self.time_zone or site.site.time_zone,
            span=self.span,
            on=self.date,
            modes=self.modes,
            strategies=self.strategies,
            held=self._held(location),
            step_min=self.step_min,
            fidelity=self.fidelity,
            light=self.light,
            weather_file=self.weather_file,
            around=Around(self.transposition, self.albedo),
            module=Module(self.power_w, self.per_kelvin, self.losses_percent, self.air_degc, self.wind_mps),
            costs=DriveCosts(self.degree_wh, self.start_wh, self.standby_w),
            deadband_deg=self.deadband_deg,
            interval_min=self.interval_min,
            program=self.program or _program(tracker),
            rows_ratio=self.rows_ratio,
            range_deg=self.range_deg,
            axis_tilt_deg=self.axis_tilt_deg,
            tracker=tracker,
        )

    def _title(self) -> str:
        match self.span:
            case Span.DAY:
                return f"{self.date}"
            case Span.TWELVE_DAYS:
                return say("12 days of {date}", date=with_format(self.date, "%Y"))
            case Span.YEAR:
                return say("Year {date}", date=with_format(self.date, "%Y"))

    def _held(self, location: Location) -> Orientation:
        towards_deg = 180.0 if location.latitude_deg >= 0.0 else 0.0
        return Orientation(
            towards_deg if self.azimuth_deg is None else self.azimuth_deg,
            90.0 - abs(location.latitude_deg) if self.elevation_deg is None else self.elevation_deg,
        )


class NewProgram(Place):
    """Which step programs to find, and where to use one of them."""

    date: Day = Field(examples=["2026-06-21"])
    most_steps: int = Field(12, ge=1, le=48)
    range_deg: float = Field(60.0, ge=5, le=120, description="Hour angle to either side of noon.")
    step_s: float = Field(0.0, ge=0, le=3600, description="How long a step takes.")
    light: ProgramLight = ProgramLight.MELISS
    turbidity: float = Field(3.0, ge=1, le=10, description="For Meliss's model.")
    window: bool = Field(False, description="Count energy from 6 h to 18 h solar time only.")
    tilt_deg: float | None = Field(None, ge=-90, le=90, description="Towards the south; left out: the best.")
    area_m2: float = Field(1.26, ge=0.01, le=1e6)
    efficiency: float = Field(0.15, ge=0.001, le=1)
    degree_wh: float = Field(0.0, ge=0, le=1e4, description="What a degree of travel takes, Wh.")
    move_wh: float = Field(0.0, ge=0, le=1e5, description="What a move takes, Wh.")
    steps: int | None = Field(None, ge=1, le=48, description="Which one to use; left out: the best number.")
    use_on: str | None = Field(None, max_length=64, description="Id of the tracker that is to run it.")

    def question(self, site: SiteDetail) -> ProgramQuestion:
        """Return what to find; raises `ValueError` with sentences."""
        return ProgramQuestion(
            location=self.location(site),
            on=self.date,
            most_steps=self.most_steps,
            range_deg=self.range_deg,
            step_s=self.step_s,
            light=self.light,
            turbidity=self.turbidity,
            window=self.window,
            tilt_deg=self.tilt_deg,
            area_m2=self.area_m2,
            efficiency=self.efficiency,
            degree_wh=self.degree_wh,
            move_wh=self.move_wh,
        )


def glance_question(detail: SiteDetail, location: Location, year: int) -> CompareSite:
    """Return the comparison of a site: its first tracker's axes, a panel tilted by the latitude.

    Where the year is not one of those that are compared, it is the nearest of them.
    """
    year = min(max(year, FIRST_YEAR), LAST_YEAR)
    trackers = tuple(detail.trackers.values())
    config = trackers[0].state.config if trackers else TrackerConfig("T1", "T1")
    towards_deg = 180.0 if location.latitude_deg >= 0.0 else 0.0
    held = Orientation(towards_deg, 90.0 - abs(location.latitude_deg))
    return CompareSite(config, location, year, held, ClearSky(location.altitude_m))


def chosen_program(answer: ProgramAnswer, steps: int | None) -> StepProgram:
    """Return the program of so many steps, of the best number where none is given, for a tracker."""
    wanted = answer.best if steps is None else steps
    row = next((one for one in answer.rows if one.steps == wanted), None)
    if row is None:
        raise ValueError(
            say(
                "A program of {wanted} steps is not possible; the maximum is {steps}.",
                wanted=wanted,
                steps=answer.rows[-1].steps,
            )
        )
    asked = answer.question
    steps_held = Steps(row.starts_h, row.angles_deg, row.tilt_deg, asked.step_s / 3600.0)
    name = say(
        "{steps} steps, {on}, +-{range_deg} degrees",
        steps=row.steps,
        on=asked.on,
        range_deg=with_format(asked.range_deg, "g"),
    )
    return step_program(name, steps_held, asked.location.latitude_deg)


def _tracker(site: SiteDetail, tracker_id: str | None) -> TrackerConfig | None:
    if tracker_id is None:
        return None
    if tracker_id not in site.trackers:
        raise UnknownTracker(tracker_id)
    return site.trackers[tracker_id].state.config


def _program(tracker: TrackerConfig | None) -> StepProgram | None:
    if tracker is None or not isinstance(tracker.strategy, Stepped):
        return None
    return tracker.strategy.program
