"""A day, or a show, simulated at controller fidelity on a virtual clock, as a recording."""

from array import array
from base64 import b64encode
from dataclasses import replace
from datetime import UTC, date, datetime, time, timedelta
from math import ceil
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from app.base.message import N_, Message, say, with_format
from app.base.zones import zone_of
from app.show.rehearsal import SHORT_STEP, Rehearsal, RehearsalFailed
from app.show.simulated_weather import MadeUpWeather
from app.store.chunks import encode_all
from app.sun.events import day_events
from app.sun.position import Location, SunPosition, sun_path
from app.tracker.commands.commands import GoToStart, Move, RunShow, SelectMode, Track
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.programs.show import ShowPlan, schedule_of
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.weather.weather_day import WeatherDay

SECOND = timedelta(seconds=1)
LONGEST = timedelta(days=3)
MOST_FRAMES = 1_000_000
DRIVE = N_("Simulated tracker on a virtual clock; no real tracker moved.")


def simulate(
    config: TrackerConfig,
    pointing: Pointing,
    location: Location,
    time_zone: str,
    mode: Mode,
    orientation: Orientation,
    begin: datetime,
    end: datetime,
    *,
    step: timedelta = SECOND,
    title: str = "",
    sparing: bool = False,
    weather: WeatherDay | None = None,
) -> tuple[RecordingInfo, Frames]:
    """Return what the tracker would do from `begin` to `end`; it is homed and in place at the beginning.

    It ticks at least once a second; `sparing` once a `step` while both axes are halted, which is quicker. The
    `weather` begins with the day, once the tracker is in place.
    """
    _check_span(begin, end, step)
    begin, end = begin.astimezone(UTC), end.astimezone(UTC)
    rehearsal = Rehearsal(config, pointing, location, begin)
    rehearsal.home()
    rehearsal.ask(SelectMode(mode, orientation))
    rehearsal.ask(Move(orientation) if mode is Mode.FIXED else Track())
    rehearsal.prepare_until(_settled, N_("it was in position"))
    rehearsal.weather = None if weather is None else MadeUpWeather(weather)
    frames = _run(rehearsal, begin, end, step, sparing=sparing)
    info = _info(config, location, time_zone, mode, orientation, begin, end)
    return _finished(info, title or _day_title(config, time_zone, begin), frames), frames


def simulate_show(
    config: TrackerConfig,
    pointing: Pointing,
    time_zone: str,
    plan: ShowPlan,
    *,
    step: timedelta = SHORT_STEP,
    title: str = "",
) -> tuple[RecordingInfo, Frames]:
    """Return what the tracker would do in a show, from its start position on."""
    rehearsal = Rehearsal(config, pointing, plan.location, plan.begin_at)
    rehearsal.home()
    rehearsal.ask(GoToStart(plan))
    rehearsal.prepare_until(_ready_for_show, N_("it was at the start of the show"))
    rehearsal.ask(RunShow(plan))
    rows = _run_show(rehearsal, plan, step)
    info = _info(config, plan.location, time_zone, plan.mode, plan.orientation, plan.begin_at, plan.end_at)
    frames = Frames(np.array(rows, dtype=np.float64).reshape(-1, len(COLUMNS)))
    return _finished(info, title or _show_title(plan, time_zone), frames), frames


def simulate_date(
    config: TrackerConfig,
    location: Location,
    time_zone: str,
    day: date,
    *,
    mode: Mode = Mode.DUAL,
    step: timedelta = SECOND,
) -> tuple[RecordingInfo, Frames]:
    """Return a simulation of a local day, midnight to midnight."""
    begin, end = _local_day(day, time_zone)
    held = Orientation(180.0, 45.0)
    return simulate(config, Pointing(), location, time_zone, mode, held, begin, end, step=step)


def simulate_show_of_date(
    config: TrackerConfig,
    location: Location,
    time_zone: str,
    day: date,
    duration: timedelta,
    *,
    mode: Mode = Mode.DUAL,
) -> tuple[RecordingInfo, Frames]:
    """Return the simulation of a show of a local day from sunrise to sunset, the whole day in polar day."""
    begin, end = _local_day(day, time_zone)
    sun = day_events(config.algorithm, location, begin, end)
    held = Orientation(180.0, 45.0)
    plan = ShowPlan(
        show_id="simulated",
        begin_at=sun.rise or begin,
        end_at=sun.set or end,
        duration=duration,
        location=location,
        mode=mode,
        orientation=held,
        algorithm=config.algorithm,
        schedule=schedule_of(config.strategy),
    )
    return simulate_show(config, Pointing(), time_zone, plan)


def _local_day(day: date, time_zone: str) -> tuple[datetime, datetime]:
    zone = zone_of(time_zone)
    begin, end = (datetime.combine(at, time.min, zone) for at in (day, day + timedelta(days=1)))
    return begin, end


def encoded(frames: Frames) -> tuple[str, ...]:
    """Return frames as `SaveRecording` carries them: base64 of the store's own encoding."""
    return tuple(b64encode(chunk).decode() for chunk in encode_all(frames))


def _check_span(begin: datetime, end: datetime, step: timedelta) -> None:
    if begin.tzinfo is None or end.tzinfo is None:
        raise ValueError(N_("Enter the start and the end of a simulation with their time zone."))
    if not timedelta(0) < end - begin <= LONGEST:
        raise ValueError(N_("A simulation must end after it starts and last at most three days."))
    if not SHORT_STEP <= step <= timedelta(minutes=1):
        raise ValueError(N_("The step of a simulation must be 0.1 to 60 seconds."))
    if (end - begin) / step > MOST_FRAMES:
        raise ValueError(
            say(
                "A simulation has at most {most_frames} samples; choose a longer step.",
                most_frames=MOST_FRAMES,
            )
        )


def _settled(seen: Snapshot) -> bool:
    turning = [axis is not None and axis.moving for axis in (seen.azimuth, seen.elevation)]
    return not any(turning) and seen.activity in (ActivityName.TRACKING, ActivityName.HOLDING)


def _ready_for_show(seen: Snapshot) -> bool:
    return seen.show is not None and seen.show.phase is ShowPhase.READY


def _run(rehearsal: Rehearsal, begin: datetime, end: datetime, step: timedelta, *, sparing: bool) -> Frames:
    """Tick through the span and return the frames."""
    ticks_a_frame = ceil(step / SECOND)
    tick_step = step / ticks_a_frame
    count = int((end - begin) / step) * ticks_a_frame + 1
    elapsed_s = np.asarray(np.arange(count) * tick_step.total_seconds(), dtype=np.float64)
    path = sun_path(rehearsal.config.algorithm, rehearsal.location, begin.timestamp() + elapsed_s)
    columns = (path.azimuth_deg, path.elevation_deg, path.apparent_elevation_deg)
    tick, frame, advance = rehearsal.tick, rehearsal.controller.frame, rehearsal.clock.advance
    rows = array("d")
    for number, sun in enumerate(zip(*(column.tolist() for column in columns), strict=True)):
        advance(tick_step)
        framed = number % ticks_a_frame == 0
        if framed or not (sparing and rehearsal.stands):
            tick(SunPosition(*sun))
        if framed:
            rows.extend(frame())
        rehearsal.site_time += tick_step
    return _frames(np.frombuffer(rows, dtype=np.float64), elapsed_s[::ticks_a_frame])


def _run_show(rehearsal: Rehearsal, plan: ShowPlan, step: timedelta) -> list[tuple[float, ...]]:
    begun = rehearsal.clock.now()
    rows: list[tuple[float, ...]] = []
    while rehearsal.clock.now() - begun <= plan.duration + timedelta(minutes=5):
        events = rehearsal.tick()
        show = rehearsal.controller.snapshot(rehearsal.site_time).show
        if any(event.kind is EventKind.SHOW_ENDED for event in events) or show is None:
            return rows
        sun_s = (show.sun_time - plan.begin_at).total_seconds()
        elapsed_s = (rehearsal.clock.now() - begun).total_seconds()
        rows.append((elapsed_s, sun_s, *rehearsal.controller.frame()[2:]))
        rehearsal.clock.advance(step)
    raise RehearsalFailed(N_("The simulated show did not end within its planned time."))


def _frames(rows: NDArray[np.float64], elapsed_s: NDArray[np.float64]) -> Frames:
    values = rows.reshape(-1, len(COLUMNS))
    values[:, 0] = elapsed_s
    values[:, 1] = elapsed_s
    return Frames(values)


def _day_title(config: TrackerConfig, time_zone: str, begin: datetime) -> Message:
    return say(
        "Simulated {astimezone}, {name}",
        astimezone=with_format(begin.astimezone(zone_of(time_zone)), "%Y-%m-%d"),
        name=config.name,
    )


def _show_title(plan: ShowPlan, time_zone: str) -> Message:
    begin, end = (at.astimezone(zone_of(time_zone)) for at in (plan.begin_at, plan.end_at))
    return say(
        "Simulated show of {begin} to {end}",
        begin=with_format(begin, "%Y-%m-%d %H:%M"),
        end=with_format(end, "%H:%M"),
    )


def _finished(info: RecordingInfo, title: str, frames: Frames) -> RecordingInfo:
    """Return the head with what is known at the end."""
    lasted_s = float(frames.values[-1, 0]) if len(frames) else 0.0
    return replace(
        info,
        title=title,
        ended_at=info.began_at + timedelta(seconds=lasted_s),
        duration_s=lasted_s,
        outcome="completed",
        sample_count=len(frames),
    )


def _info(
    config: TrackerConfig,
    location: Location,
    time_zone: str,
    mode: Mode,
    orientation: Orientation,
    begin: datetime,
    end: datetime,
) -> RecordingInfo:
    return RecordingInfo(
        recording_id=f"simulation-{uuid4().hex}",
        kind=RecordingKind.SIMULATION,
        tracker_id=config.tracker_id,
        tracker_name=config.name,
        title="",
        began_at=begin,
        sun_start=begin,
        sun_end=end,
        duration_s=(end - begin).total_seconds(),
        location=location,
        time_zone=time_zone,
        mode=mode,
        held_azimuth_deg=orientation.azimuth_deg,
        held_elevation_deg=orientation.elevation_deg,
        algorithm=config.algorithm.value,
        drive=DRIVE,
        mount=config.mount,
        first_deg=config.turning_deg[0],
        second_deg=config.turning_deg[1],
    )
