"""A whole day at the controller's fidelity on a virtual clock; nothing moves."""

from dataclasses import replace
from datetime import datetime, timedelta, tzinfo
from typing import Annotated, Self

from fastapi.responses import Response
from pydantic import Field, model_validator

from app.base.instants import Day, Instant
from app.base.message import N_, told_by
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.link.messages import SaveRecording
from app.sun.algorithms import Algorithm
from app.tracker.memory.recording import RecordingInfo
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.mode import Mode
from app.tracker.weather.simulated_weather import MOST_SEED, Scenario
from app.tracker.weather.weather_day import (
    MOST_STEPS,
    WeatherDay,
    WeatherStep,
    after_midnight,
    day_of_scenario,
    midnight_before,
    read_steps,
    stepped_day,
)
from app.web.api.base import NOT_FOUND, REFUSED, TOO_MANY, Azimuth, Clean, Elevation, Input, api_router
from app.web.api.orders import SenderDep
from app.web.api.sun import location_of, midnights
from app.web.api.trackers import detail_of
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.services.simulations import SimulationRequest
from app.web.shell.deps import MachineDep, PanelDep, SnapshotDep

router = api_router(tags=["recordings"])


class DayStepIn(Input):
    """What the weather is from a time on; what is left out stays as it was, the light of a clear sky."""

    time: str = Field(
        max_length=8, description="Hours and minutes after the first midnight.", examples=["11:30"]
    )
    wind_mps: float | None = None
    gustiness_pct: float | None = None
    wind_direction_deg: float | None = None
    irradiance_wm2: float | None = None
    snow_kg: float | None = None
    temperature_degc: float | None = None

    def step(self) -> WeatherStep:
        """Return it in the domain's words, or raise `ValueError`."""
        given = self.model_dump(exclude_none=True, exclude={"time"})
        return WeatherStep(after_midnight(self.time, N_("The incremental jog")), given)


class DayWeatherIn(Input):
    """The weather of the day: a scenario that begins at a time, or steps, as a list or as CSV."""

    scenario: Scenario | None = Field(None, description="calm, storm, snowfall or clouds.")
    begins: str = Field("12:00", max_length=8, description="When the scenario begins, by the site's clock.")
    seed: int = Field(1, ge=0, le=MOST_SEED)
    steps: tuple[DayStepIn, ...] | None = Field(None, max_length=MOST_STEPS)
    csv: str | None = Field(None, max_length=100_000, examples=["time,wind_mps\n10:00,4\n14:00,22\n14:10,3"])

    @model_validator(mode="after")
    def _one_of_three(self) -> Self:
        if [self.scenario, self.steps, self.csv].count(None) != 2:
            raise ValueError(N_("Give one of scenario, steps, and csv."))
        return self

    def day(self, begin: datetime, zone: tzinfo) -> WeatherDay:
        """Return the weather of the day on which a simulation begins, or raise `ValueError`."""
        if self.scenario is not None:
            return day_of_scenario(self.scenario, self.begins, self.seed, begin, zone)
        steps = read_steps(self.csv or "") if self.steps is None else tuple(one.step() for one in self.steps)
        return stepped_day(steps, midnight_before(begin, zone), zone, self.seed)


class NewSimulation(Input):
    """Which tracker and which span: a civil `date` from midnight to midnight, or `start` and `end`."""

    tracker_id: str = Field(min_length=1, max_length=64, examples=["T1"])
    date: Day | None = Field(None, description="Civil date of the site.", examples=["2026-06-21"])
    start: Instant | None = None
    end: Instant | None = None
    mode: Mode | None = Field(None, description="Left out: the tracker's selected mode, else dual.")
    azimuth_deg: Azimuth | None = Field(None, description="For modes that hold the azimuth.")
    elevation_deg: Elevation | None = Field(None, description="For modes that hold the elevation.")
    step_s: float = Field(1.0, ge=0.1, le=60, description="Seconds between samples.")
    algorithm: Algorithm | None = Field(None, description="Left out: the tracker's own.")
    weather: DayWeatherIn | None = Field(None, description="Left out: no weather, and no protection acts.")
    title: Annotated[str, Clean] = Field("", max_length=120)

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        both = self.start is not None and self.end is not None
        neither = self.start is None and self.end is None
        if not ((both and self.date is None) or (neither and self.date is not None)):
            raise ValueError(N_("Give date alone, or start and end."))
        return self

    def span(self, site: SiteSnapshot) -> tuple[datetime, datetime]:
        """Return begin and end."""
        if self.start is not None and self.end is not None:
            return self.start, self.end
        return midnights(self.date or day_in(site.time_zone, site.at), site.time_zone)


@router.post(
    "/simulations",
    status_code=201,
    summary="Simulate a day",
    responses=NOT_FOUND | REFUSED | TOO_MANY,
)
@needs(Permission.SIMULATE)
async def simulate_span(
    new: NewSimulation,
    panel: PanelDep,
    site: SnapshotDep,
    machine: MachineDep,
    sender: SenderDep,
    response: Response,
) -> RecordingInfo:
    """Simulate a tracker as it is set now, homed and in place at the beginning, and keep the recording."""
    state = (await detail_of(machine, new.tracker_id)).state
    held = state.memory.orientation
    begin, end = new.span(site)
    try:
        weather = None if new.weather is None else new.weather.day(begin, zone_of(site.time_zone))
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    request = SimulationRequest(
        config=replace(state.config, algorithm=new.algorithm or state.config.algorithm),
        pointing=state.memory.pointing,
        location=location_of(site),
        time_zone=site.time_zone,
        mode=new.mode or state.memory.mode or Mode.DUAL,
        held=Orientation(
            held.azimuth_deg if new.azimuth_deg is None else new.azimuth_deg,
            held.elevation_deg if new.elevation_deg is None else new.elevation_deg,
        ),
        begin=begin,
        end=end,
        step=timedelta(seconds=new.step_s),
        title=new.title,
        weather=weather,
        horizon=(await machine.detail()).site.horizon,
    )
    try:
        info, chunks = await panel.simulations.run(request)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    await sender.send(SaveRecording(info, chunks))
    response.headers["Location"] = f"/api/v1/recordings/{info.recording_id}"
    return info
