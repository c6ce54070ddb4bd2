"""Records every show from its first frame, and every day at one a second once place and time are set."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, time, timedelta
from struct import Struct

import numpy as np

from app.base.message import say, with_format
from app.base.zones import zone_of
from app.site.loop.loop import TrackerLoop
from app.site.recording.sample_batches import MOST_WAITING, SampleBatches
from app.site.recording.write_queue import Ledger
from app.sun.position import Location
from app.tracker.activities.tracking import sun_height_deg
from app.tracker.memory.memory import SiteState
from app.tracker.memory.observation import Observation
from app.tracker.memory.recording import COLUMNS, Frames, RecordingInfo, RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.state.snapshot import Event, EventKind, ShowPhase, ShowProgress
from app.tracker.values.mode import Mode

ROW = Struct(f"={len(COLUMNS)}d")
DAY_STEP = timedelta(seconds=1)
RECORDED_PHASES = {ShowPhase.RUNNING, ShowPhase.PAUSED}


@dataclass(slots=True)
class _Open:
    """A recording that runs: its head and its newest samples, the oldest lost while the disk takes none."""

    info: RecordingInfo
    began: datetime
    due: datetime
    rows: deque[bytes] = field(default_factory=lambda: deque(maxlen=MOST_WAITING))

    def add(self, now: datetime, sun_time: datetime, frame: tuple[float, ...]) -> None:
        elapsed_s = (now - self.began).total_seconds()
        sun_s = (sun_time - self.info.sun_start).total_seconds()
        self.rows.append(ROW.pack(elapsed_s, sun_s, *frame[2:]))

    def take(self) -> Frames:
        """Return the samples and forget them; packed ones of all trackers are quickly made into arrays."""
        values = np.frombuffer(b"".join(self.rows)).reshape(-1, len(COLUMNS))
        self.rows.clear()
        return Frames(values)


class Recorder:
    """Turns ticks into recordings; the store gets them in batches, behind the loop."""

    def __init__(self, ledger: Ledger, period: timedelta, every: timedelta) -> None:
        self._ledger = ledger
        self._period = period
        self._batches = SampleBatches(ledger, every)
        self._plans: dict[str, ShowPlan] = {}
        self._shows: dict[str, _Open] = {}
        self._days: dict[str, _Open] = {}
        self._suspended: set[str] = set()

    @property
    def samples_waiting(self) -> int:
        """Return how many samples are not yet on the disk."""
        return self._batches.samples_waiting + sum(len(one.rows) for one in self._running())

    @property
    def stored_at(self) -> datetime | None:
        """Return when samples went to the disk last, by the clock that ticks are timed with."""
        return self._batches.handed_over_at

    def is_open(self, recording_id: str) -> bool:
        """Return whether a recording still runs."""
        return any(one.info.recording_id == recording_id for one in self._running())

    @property
    def is_suspended(self) -> bool:
        """Return whether no samples are recorded."""
        return bool(self._suspended)

    def suspend(self, why: str) -> None:
        """Record no samples until this reason is taken back; recordings begin and end as ever."""
        self._suspended.add(why)

    def resume(self, why: str) -> None:
        """Take a reason back; without any samples are recorded again."""
        self._suspended.discard(why)

    def announce(self, tracker_id: str, plan: ShowPlan) -> None:
        """Remember the plan of the show that this tracker is about to run."""
        self._plans[tracker_id] = plan

    def observe(
        self, loop: TrackerLoop, site: SiteState, seen: Observation, events: tuple[Event, ...]
    ) -> None:
        """Add what this tick showed to the recordings of its tracker; what began or ended is stored soon."""
        if self._ledger.writer is None:
            return
        tracker_id = loop.config.tracker_id
        for event in events:
            if event.kind is EventKind.SHOW_ENDED:
                self._finish(self._shows, tracker_id, seen.site_time, _outcome(event))
        if tracker_id in self._plans:
            self._observe_show(loop, site, seen)
        self._observe_day(loop, site, seen)
        self.flush(seen.now)

    def flush(self, now: datetime, *, at_once: bool = False) -> None:
        """Hand what waits to the store in one transaction, if it is time."""
        if self._ledger.writer is not None and (at_once or self._batches.is_due(now)):
            self._batches.add({one.info.recording_id: one.take() for one in self._running() if one.rows})
            self._batches.hand_over(now)

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
            self._add(running, seen.now, show.sun_time, loop.controller.frame())

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
            self._add(day, seen.now, seen.site_time, _day_frame(loop, seen))

    def _running(self) -> Iterator[_Open]:
        yield from self._shows.values()
        yield from self._days.values()

    def _begin(self, among: dict[str, _Open], info: RecordingInfo, now: datetime) -> _Open:
        opened = _Open(info, now, now)
        among[info.tracker_id] = opened
        self._batches.begin(info)
        return opened

    def _add(self, one: _Open, now: datetime, sun_time: datetime, frame: tuple[float, ...]) -> None:
        if not self.is_suspended:
            one.add(now, sun_time, frame)

    def _finish(self, among: dict[str, _Open], tracker_id: str, at: datetime, outcome: str) -> None:
        one = among.pop(tracker_id, None)
        if one is None or self._ledger.writer is None:
            return
        if one.rows:
            self._batches.add({one.info.recording_id: one.take()})
        self._batches.end(one.info.recording_id, at, outcome)


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
    return same_place and info.sun_start <= at < info.sun_end


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
        sun_start=at,
        sun_end=midnight,
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
        title=say(
            "Show of {begin} to {end}",
            begin=with_format(begin, "%Y-%m-%d %H:%M"),
            end=with_format(end, "%H:%M"),
        ),
        began_at=at,
        sun_start=plan.begin_at,
        sun_end=plan.end_at,
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
