"""The plan of a show as a form: what stands in it at first, what was typed, and what the check says."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date, datetime, time, timedelta
from math import ceil
from urllib.parse import urlencode
from uuid import uuid4

from pydantic import BaseModel

from app.base.instants import duration
from app.base.message import N_, Message, Word, join, say, with_format
from app.base.zones import zone_of
from app.link.messages import TrackerDetail
from app.sun.accuracy import FIRST_YEAR, LAST_YEAR
from app.sun.daylight import daylight, next_daylight
from app.sun.position import InstantRefused, Location
from app.tracker.mounts.capabilities import axis_title, default_mode
from app.tracker.programs.show import ShowCheck, ShowPlan, check_show, schedule_of
from app.tracker.programs.usual import in_usual_time
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.reason import Reason
from app.tracker.values.typed_numbers import written
from app.web.charts.daychart import chart
from app.web.features.control.mode import choice
from app.web.features.shows.show_contexts import Preset, Verdict
from app.web.shell.contexts import Link
from app.web.shell.formats import ISO_DATE, local, read_local
from app.web.shell.forms import Typed

NAMES = ("date", "start", "end", "minutes")
LONGEST_MIN = 1440
SHORTEST_LIGHT = timedelta(minutes=10)
"""A day with less sun than this between two sunsets is shown whole."""


class ShowForm(BaseModel):
    """The form as it was typed; what was not sent at all is filled in."""

    date: str | None = None
    start: str | None = None
    end: str | None = None
    minutes: str | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """What the plan of a show depends on: the tracker, where it stands, its clock and its day."""

    tracker: TrackerDetail
    location: Location
    zone: str
    today: date

    @property
    def config(self) -> TrackerConfig:
        """Return how the tracker is set."""
        return self.tracker.state.config


@dataclass(frozen=True, slots=True)
class Planned:
    """The form as it stands, the plan that it makes (None: something is missing) and what is said of it."""

    typed: Typed
    plan: ShowPlan | None
    verdict: Verdict | None


def planned(form: ShowForm, place: Place) -> Planned:
    """Return the form with all that was not typed filled in so that the show works, if any does."""
    texts = {name: text for name, text in form.model_dump().items() if text is not None}
    texts = _with_span(texts, place)
    chosen = "minutes" not in texts
    typed = Typed({"minutes": "3"} | texts)
    plan = read(typed, place)
    if plan is None:
        return Planned(typed, None, None)
    memory = place.tracker.state.memory
    if not chosen:
        check, longer = check_show(plan, place.config, memory.pointing), None
    else:
        usual = in_usual_time(plan, place.config, memory.pointing)
        plan, check, longer = usual.plan, usual.check, usual.longer
        typed.texts["minutes"] = _minutes(plan.duration)
    return Planned(typed, plan, _verdict(check, plan, place, typed, longer))


def read(typed: Typed, place: Place) -> ShowPlan | None:
    """Return the plan that was typed; an end that is not after the start lies on the next day."""
    day = typed.day("date", N_("Date"))
    start, end = typed.clock_time("start", N_("Start")), typed.clock_time("end", N_("End session"))
    minutes = typed.number("minutes", N_("Minutes"), 0.1, LONGEST_MIN, "min")
    if typed.errors:
        return None
    last_day = day if end > start else day + timedelta(days=1)
    config, memory = place.config, place.tracker.state.memory
    return ShowPlan(
        show_id=uuid4().hex[:12],
        begin_at=datetime.combine(day, start, zone_of(place.zone)),
        end_at=datetime.combine(last_day, end, zone_of(place.zone)),
        duration=timedelta(seconds=round(minutes * 60)),
        location=place.location,
        mode=memory.mode or default_mode(config.mount),
        orientation=memory.orientation,
        algorithm=config.algorithm,
        refraction=config.refraction,
        schedule=schedule_of(config.strategy),
    )


def presets(place: Place, typed: Typed) -> tuple[Preset, ...]:
    """Return the days that one key chooses; the length of each show is what that day takes."""
    year = place.today.year
    days = (
        (N_("Today"), "", place.today),
        (N_("21 March"), N_("Equinox"), date(year, 3, 21)),
        (N_("21 June"), N_("Solstice"), date(year, 6, 21)),
        (N_("21 December"), N_("Solstice"), date(year, 12, 21)),
    )
    return tuple(
        Preset(label, what, f"?{urlencode({'date': day.isoformat()})}", _is_whole(day, place, typed))
        for label, what, day in days
    )


def _is_whole(day: date, place: Place, typed: Typed) -> bool:
    """Return whether the form holds a day from sunrise to sunset."""
    return typed.texts.get("date") == day.isoformat() and all(
        typed.texts.get(name) == text for name, text in _span(place, day).items()
    )


def _with_span(texts: Mapping[str, str], place: Place) -> dict[str, str]:
    """Return the texts of a form with a date, and with the daylight of that date where no time was sent."""
    dated = {"date": place.today.isoformat()} | dict(texts)
    try:
        day = date.fromisoformat(dated["date"])
    except ValueError:
        day = place.today
    span = {} if {"start", "end"} & set(texts) else _span(place, day)
    return dated | span


def _span(place: Place, day: date) -> dict[str, str]:
    """Return when the daylight of a day begins and ends, or midnight twice where a day has no such thing."""
    lit = _lit(place, day)
    if lit is None or lit[1] - lit[0] < SHORTEST_LIGHT:
        return {"start": "00:00", "end": "00:00"}
    begin = lit[0] + timedelta(seconds=59)
    return {"start": local(begin, place.zone, "%H:%M"), "end": local(lit[1], place.zone, "%H:%M")}


def _lit(place: Place, day: date) -> tuple[datetime, datetime] | None:
    if not FIRST_YEAR <= day.year <= LAST_YEAR:
        return None
    begin, end = (
        datetime.combine(one, time(), zone_of(place.zone)) for one in (day, day + timedelta(days=1))
    )
    try:
        return daylight(place.config.algorithm, place.location, begin, end)
    except InstantRefused:
        return None


def _minutes(length: timedelta) -> str:
    """Return a length as the form has it, rounded up, so that what works still does."""
    return written(ceil(length.total_seconds() / 60 * 10_000) / 10_000, LONGEST_MIN)


def _verdict(check: ShowCheck, plan: ShowPlan, place: Place, typed: Typed, longer: Reason | None) -> Verdict:
    return Verdict(
        feasible=check.feasible,
        headline=_headline(check, plan),
        facts=_facts(check, plan, place),
        reasons=check.reasons,
        longer=longer,
        notices=check.notices,
        instead=_instead(check, plan, place, typed),
        chart=chart(check.path, place.zone),
    )


def _headline(check: ShowCheck, plan: ShowPlan) -> Message:
    if not check.feasible:
        return N_("This show cannot be run.")
    return say(
        "This works: {duration}, {acceleration} × the sun's speed.",
        duration=duration(plan.duration),
        acceleration=with_format(plan.acceleration, ".0f"),
    )


def _instead(check: ShowCheck, plan: ShowPlan, place: Place, typed: Typed) -> Link | None:
    """Return what can be done where a show cannot be run: a longer one, or one on which the sun is up."""
    if check.feasible:
        return None
    if check.shortest is not None:
        texts = {name: typed.texts[name] for name in NAMES} | {"minutes": _minutes(check.shortest)}
        return Link(say("Use {shortest} instead", shortest=duration(check.shortest)), f"?{urlencode(texts)}")
    codes = {reason.code for reason in check.reasons}
    if "mode_not_possible" in codes:
        return Link(N_("Choose another mode"), f"/trackers/{place.config.tracker_id}/commissioning/mode")
    return _with_sun(plan, place) if "sun_never_up" in codes else None


def _with_sun(plan: ShowPlan, place: Place) -> Link | None:
    """Return the daylight of the day that was typed, or the next day that has enough of it."""
    day = plan.begin_at.date()
    if (found := _lit(place, day)) is not None and found[1] - found[0] >= SHORTEST_LIGHT:
        begin, end = (local(at, place.zone, "%H:%M") for at in found)
        label = say("Use sunrise to sunset instead: {begin} to {end}", begin=begin, end=end)
        return Link(label, f"?{urlencode({'date': day.isoformat()})}")
    after = plan.begin_at.replace(hour=0, minute=0, second=0)
    lit_at = next_daylight(place.config.algorithm, place.location, after)
    if lit_at is None:
        return None
    on = lit_at.astimezone(zone_of(place.zone)).date()
    shown = read_local(lit_at, place.zone, ISO_DATE)
    label = say("Use {shown}, the next day with an hour of sun", shown=shown)
    return Link(label, f"?{urlencode({'date': on.isoformat()})}")


def _facts(check: ShowCheck, plan: ShowPlan, place: Place) -> tuple[tuple[str, str], ...]:
    config, zone = place.config, place.zone
    spans = join(
        ", ",
        (say("{a} to {b}", a=local(a, zone, "%H:%M"), b=local(b, zone, "%H:%M")) for a, b in check.sun_up),
    )
    return (
        (N_("Mode"), choice(config, plan.mode).label),
        (N_("Sun up"), spans or N_("not in this interval")),
        *_axis_facts(check, config),
    )


def _axis_facts(check: ShowCheck, config: TrackerConfig) -> tuple[tuple[str, str], ...]:
    """Return what the show asks of each axis that the mount has, and where they begin."""
    asked = (
        (Axis.AZIMUTH, check.peak_azimuth_dps, check.start.azimuth_deg),
        (Axis.ELEVATION, check.peak_elevation_dps, check.start.elevation_deg),
    )
    present = [(axis_title(config.mount, axis), axis, dps, deg) for axis, dps, deg in asked]
    present = [one for one in present if one[1] in config.mount.axes]
    return (
        *(
            (
                say("{capitalize} speed", capitalize=Word(title.capitalize())),
                say(
                    "{dps} of {speed_dps} °/s",
                    dps=with_format(dps, ".2f"),
                    speed_dps=with_format(config.axis(axis).speed_dps, "g"),
                ),
            )
            for title, axis, dps, _ in present
        ),
        (
            N_("Begins at"),
            join(
                ", ",
                (
                    say("{title} {deg}°", title=title, deg=with_format(deg, ".1f"))
                    for title, _, _, deg in present
                ),
            ),
        ),
    )
