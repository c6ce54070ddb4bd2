"""Records every show from its first frame, and every day at one a second once place and time are set."""

from dataclasses import dataclass, field
from datetime import UTC, datetime, time, timedelta

import numpy as np

from app.site.ledger import Ledger
from app.site.loop import TrackerLoop
from app.sun.position import Location
from app.tracker.activities.tracking import sun_height_deg
from app.tracker.memory import SiteState
from app.tracker.mode import Mode
from app.tracker.observation import Observation
from app.tracker.programs.show import ShowPlan
from app.tracker.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.snapshot import Event, EventKind, ShowPhase, ShowProgress
from app.zones import zone_of

DAY_STEP = timedelta(seconds=1)
RECORDED_PHASES = {ShowPhase.RUNNING, ShowPhase.PAUSED}


@dataclass(slots=True)
class _Open:
    """A recording that runs: its head and the frames that are not yet handed to the store."""

    info: RecordingInfo
    began: datetime
    due: datetime
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, now: datetime, sun_time: datetime, frame: tuple[float, ...]) -> None:
        elapsed_s = (now - self.began).total_seconds()
        sun_s = (sun_time - self.info.sun_begin_at).total_seconds()
        self.rows.append((elapsed_s, sun_s, *frame[2:]))

    def take(self) -> Frames | None:
        if not self.rows:
            return None
        values = np.array(self.rows, dtype=np.float64).reshape(-1, len(COLUMNS))
        self.rows.clear()
        return Frames(values)


class Recorder:
    """Turns ticks into recordings; frames go to the store in batches, behind the loop."""

    def __init__(self, ledger: Ledger, period: timedelta) -> None:
        self._ledger = ledger
        self._period = period
        self._plans: dict[str, ShowPlan] = {}
        self._shows: dict[str, _Open] = {}
        self._days: dict[str, _Open] = {}

    @property
    def frames_waiting(self) -> int:
        """Return how many frames are not yet handed to the store."""
        return sum(len(one.rows) for one in (*self._shows.values(), *self._days.values()))

    def is_open(self, recording_id: str) -> bool:
        """Return whether a recording still runs."""
        return any(
            one.info.recording_id == recording_id for one in (*self._shows.values(), *self._days.values())
        )

    def announce(self, tracker_id: str, plan: ShowPlan) -> None:
        """Remember the plan of the show that this tracker is about to run."""
        self._plans[tracker_id] = plan

    def observe(
        self, loop: TrackerLoop, site: SiteState, seen: Observation, events: tuple[Event, ...]
    ) -> None:
        """Add what this tick showed to the recordings of its tracker."""
        if self._ledger.writer is None:
            return
        tracker_id = loop.config.tracker_id
        for event in events:
            if event.kind is EventKind.SHOW_ENDED:
                self._finish(self._shows, tracker_id, seen.site_time, _outcome(event))
        if tracker_id in self._plans:
            self._observe_show(loop, site, seen)
        self._observe_day(loop, site, seen)

    def flush(self) -> None:
        """Hand the frames that wait to the store."""
        for one in (*self._shows.values(), *self._days.values()):
            self._append(one)

    def finish(self, tracker_id: str, at: datetime, outcome: str) -> None:
        """Close what is being recorded of one tracker."""
        self._finish(self._shows, tracker_id, at, outcome)
        self._finish(self._days, tracker_id, at, outcome)
        self._plans.pop(tracker_id, None)

    def _observe_show(self, loop: TrackerLoop, site: SiteState, seen: Observation) -> None:
        tracker_id = loop.config.tracker_id
        show = loop.controller.snapshot(seen.site_time).show
        running = self._shows.get(tracker_id)
        if show is None or show.phase not in RECORDED_PHASES:
            if running is not None:
                self._finish(self._shows, tracker_id, seen.site_time, "ended")
            if show is None:
                del self._plans[tracker_id]
            return
        if running is None:
            info = _show_info(loop, site, self._plans[tracker_id], show, seen.site_time)
            running = self._begin(self._shows, info, seen.now)
        if seen.now >= running.due - self._period / 2:
            running.due = min(max(running.due + self._period, seen.now), seen.now + self._period)
            running.add(seen.now, show.sun_time, loop.controller.frame())

    def _observe_day(self, loop: TrackerLoop, site: SiteState, seen: Observation) -> None:
        tracker_id = loop.config.tracker_id
        day = self._days.get(tracker_id)
        if day is not None and not _same_day(day.info, site, seen.site_time):
            self._finish(self._days, tracker_id, seen.site_time, "completed")
            day = None
        if day is None:
            if site.location is None or site.clock.source == "unset":
                return
            day = self._begin(self._days, _day_info(loop, site, site.location, seen.site_time), seen.now)
        if seen.now >= day.due:
            day.due = max(day.due + DAY_STEP, seen.now)
            day.add(seen.now, seen.site_time, _day_frame(loop, seen))

    def _begin(self, among: dict[str, _Open], info: RecordingInfo, now: datetime) -> _Open:
        opened = _Open(info, now, now)
        among[info.tracker_id] = opened
        writer = self._ledger.writer
        if writer is not None:
            writer.post(lambda store: store.begin_recording(info))
        return opened

    def _append(self, one: _Open) -> None:
        frames, writer = one.take(), self._ledger.writer
        if frames is not None and writer is not None:
            writer.post(lambda store: store.append_frames(one.info.recording_id, frames))

    def _finish(self, among: dict[str, _Open], tracker_id: str, at: datetime, outcome: str) -> None:
        one, writer = among.pop(tracker_id, None), self._ledger.writer
        if one is None or writer is None:
            return
        self._append(one)
        writer.post(lambda store: store.finish_recording(one.info.recording_id, at, outcome))


def _day_frame(loop: TrackerLoop, seen: Observation) -> tuple[float, ...]:
    """Return the frame of this tick with the real sun, also while a show follows another one."""
    frame = loop.controller.frame()
    if seen.sun is None:
        return frame
    return (*frame[:2], seen.sun.azimuth_deg, sun_height_deg(loop.config, seen.sun), *frame[4:])


def _outcome(event: Event) -> str:
    return str(event.data.get("outcome", event.message))


def _local(at: datetime, site: SiteState) -> datetime:
    return at.astimezone(zone_of(site.time_zone))


def _same_day(info: RecordingInfo, site: SiteState, at: datetime) -> bool:
    same_place = info.location == site.location and info.time_zone == site.time_zone
    return same_place and info.sun_begin_at <= at < info.sun_end_at


def _day_info(loop: TrackerLoop, site: SiteState, location: Location, at: datetime) -> RecordingInfo:
    local = _local(at, site)
    midnight = datetime.combine(local.date() + timedelta(days=1), time.min, local.tzinfo).astimezone(UTC)
    config, memory = loop.config, loop.memory
    return RecordingInfo(
        recording_id=f"day-{config.tracker_id}-{at:%Y%m%dT%H%M%S%f}",
        kind=RecordingKind.DAY,
        tracker_id=config.tracker_id,
        tracker_name=config.name,
        title=f"{config.name}, {local:%Y-%m-%d}",
        began_at=at,
        sun_begin_at=at,
        sun_end_at=midnight,
        duration_s=(midnight - at).total_seconds(),
        location=location,
        time_zone=site.time_zone,
        mode=memory.mode or Mode.DUAL,
        held_azimuth_deg=memory.orientation.azimuth_deg,
        held_elevation_deg=memory.orientation.elevation_deg,
        algorithm=config.algorithm.value,
        drive=loop.drive.capabilities.description,
        mount=config.mount,
        first_deg=config.turning_deg[0],
        second_deg=config.turning_deg[1],
        horizon=site.horizon,
    )


def _show_info(
    loop: TrackerLoop, site: SiteState, plan: ShowPlan, show: ShowProgress, at: datetime
) -> RecordingInfo:
    begin, end = _local(plan.begin_at, site), _local(plan.end_at, site)
    config = loop.config
    return RecordingInfo(
        recording_id=f"show-{config.tracker_id}-{at:%Y%m%dT%H%M%S%f}",
        kind=RecordingKind.SHOW,
        tracker_id=config.tracker_id,
        tracker_name=config.name,
        title=f"Show of {begin:%Y-%m-%d %H:%M} to {end:%H:%M}",
        began_at=at,
        sun_begin_at=plan.begin_at,
        sun_end_at=plan.end_at,
        duration_s=show.duration_s,
        location=plan.location,
        time_zone=site.time_zone,
        mode=plan.mode,
        held_azimuth_deg=plan.orientation.azimuth_deg,
        held_elevation_deg=plan.orientation.elevation_deg,
        algorithm=plan.algorithm.value,
        drive=loop.drive.capabilities.description,
        mount=config.mount,
        first_deg=config.turning_deg[0],
        second_deg=config.turning_deg[1],
        horizon=site.horizon,
    )
