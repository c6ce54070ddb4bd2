"""Step 1: where the tracker stands, checked against today's sun and a map before it is saved."""

from dataclasses import dataclass, replace
from datetime import datetime, time, timedelta
from functools import cache
from typing import Annotated
from zoneinfo import available_timezones

from fastapi import Form, Query
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, NOTHING, Message, say, with_format
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.link.messages import SetLocation, SiteDetail
from app.sun.events import PolarDay, SunEvents, day_events
from app.sun.position import InstantRefused, Location, sun_position
from app.tracker.memory.memory import SiteState, StepName
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.typed_numbers import written
from app.web.features.site.place import place_doubts, refuse_before_asking, swapped, zone_at
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.languages import pgettext
from app.web.shell import coordinates
from app.web.shell.contexts import LocationPage, LocationPreview
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.formats import compass, decimals, formatted, local
from app.web.shell.forms import Typed
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/location")
NAMES = ("latitude", "longitude", "altitude", "latitude_side", "longitude_side", "time_zone", "device_zone")
BY_PLACE = ""
SHOWN_DEG = 1e-4
ALTITUDES_M = (-500, 9000)


class LocationForm(BaseModel):
    """The form as it was typed; all texts."""

    latitude: str = ""
    longitude: str = ""
    altitude: str = ""
    latitude_side: str = "N"
    longitude_side: str = "E"
    time_zone: str = BY_PLACE
    device_zone: Annotated[str, MAY_BE_ABSENT] = ""
    sun_there: Annotated[str, MAY_BE_ABSENT] = ""


@dataclass(frozen=True, slots=True)
class Read:
    """What the form means: a place and its zone, unless there are errors."""

    typed: Typed
    location: Location | None
    zone: str
    doubts: tuple[str, ...] = ()
    is_pair: bool = False

    @property
    def is_asked(self) -> bool:
        """Return whether it must be confirmed that the sun is where the page says, and was not yet."""
        return bool(self.doubts) and self.typed.texts["sun_there"] != "yes"


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Show the saved location, or an empty form."""
    detail = await built.machine.detail()
    return _answer(request, tracker_id, detail, read(_saved(detail.site)), built)


@router.get("/preview")
@needs(Permission.READ)
async def preview(
    request: Request, tracker_id: str, typed: Annotated[LocationForm, Query()], built: PanelDep
) -> Response:
    """Show what the typed location would mean, without saving it."""
    detail = await built.machine.detail()
    return _answer(request, tracker_id, detail, read(typed), built, block="preview")


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    tracker_id: str, typed: Annotated[LocationForm, Form()], press: PressDep, built: PanelDep
) -> Response:
    """Save the location and go on to the clock."""
    detail = await built.machine.detail()
    found = _doubted(read(typed), detail.site, built)
    if found.location is not None and found.is_asked:
        refuse_before_asking(found.location, detail, built.machine.latest())
    if found.location is None or found.is_asked:
        return _answer(press.request, tracker_id, detail, found, built, block="form", status=422)
    await press.send(SetLocation(found.location, found.zone))
    return go(press.request, f"/trackers/{tracker_id}/commissioning/clock")


def read(form: LocationForm) -> Read:
    """Return what was typed and what it means."""
    texts = form.model_dump()
    pair = coordinates.spread(texts)
    for name, text in pair.items():
        texts |= {name: text.lstrip("-"), f"{name}_side": coordinates.AXES[name][text.startswith("-")]}
    texts |= _sides(texts)
    typed = Typed(texts)
    latitude, longitude = (coordinates.read(typed, name, texts[f"{name}_side"]) for name in coordinates.AXES)
    altitude = typed.number("altitude", N_("Altitude"), *ALTITUDES_M, "m") if form.altitude.strip() else 0.0
    if form.time_zone and form.time_zone not in zones():
        typed.errors["time_zone"] = N_("Choose a time zone from the list.")
    if typed.errors:
        return Read(typed, None, "UTC")
    place = Location(latitude, longitude, altitude)
    return Read(typed, place, form.time_zone or proposed(latitude, longitude), is_pair=bool(pair))


def _sides(texts: dict[str, str]) -> dict[str, str]:
    """Return the side of each field: that of a letter in its text, otherwise that of the pressed button."""
    counting = {}
    for name, sides in coordinates.AXES.items():
        pressed = texts[f"{name}_side"] if texts[f"{name}_side"] in tuple(sides) else sides[0]
        counting[f"{name}_side"] = coordinates.side(texts[name], name) or pressed
    return counting


def _doubted(found: Read, site: SiteState, built: Panel) -> Read:
    """Return what was typed with what speaks against it."""
    if found.location is None or _is_stored(found, site):
        return found
    device_zone = found.typed.texts["device_zone"]
    known = device_zone if device_zone in zones() else ""
    doubts = place_doubts(
        found.location, found.zone, built.site_now(), before=site.location, device_zone=known
    )
    return replace(found, doubts=doubts)


def _is_stored(found: Read, site: SiteState) -> bool:
    """Return whether this place is stored, to the digits that the form shows: it was confirmed then."""
    there, stored = found.location, site.location
    return (
        there is not None
        and stored is not None
        and found.zone == site.time_zone
        and abs(there.latitude_deg - stored.latitude_deg) < SHOWN_DEG
        and abs(there.longitude_deg - stored.longitude_deg) < SHOWN_DEG
    )


def proposed(latitude_deg: float, longitude_deg: float) -> str:
    """Return the IANA time zone of a place; UTC where none is known, as on the high sea."""
    name = zone_at(latitude_deg, longitude_deg)
    return name if name in zones() else "UTC"


@cache
def zones() -> tuple[str, ...]:
    """Return the time zones to choose from: those of places, and UTC."""
    areas = ("Africa/", "America/", "Antarctica/", "Arctic/", "Asia/", "Atlantic/", "Australia/", "Europe/",
             "Indian/", "Pacific/", "Etc/")  # fmt: skip
    return ("UTC", *sorted(name for name in available_timezones() if name.startswith(areas)))


def _saved(site: SiteState) -> LocationForm:
    place = site.location
    if place is None:
        return LocationForm()
    by_place = site.time_zone == proposed(place.latitude_deg, place.longitude_deg)
    return LocationForm(
        latitude=coordinates.degrees_text(abs(place.latitude_deg)),
        longitude=coordinates.degrees_text(abs(place.longitude_deg)),
        altitude=written(place.altitude_m, ALTITUDES_M[1]),
        latitude_side="S" if place.latitude_deg < 0 else "N",
        longitude_side="W" if place.longitude_deg < 0 else "E",
        time_zone=BY_PLACE if by_place else site.time_zone,
    )


def _answer(
    request: Request,
    tracker_id: str,
    detail: SiteDetail,
    found: Read,
    built: Panel,
    *,
    block: str | None = None,
    status: int = 200,
) -> Response:
    tracker = tracker_of(detail, tracker_id)
    frame = wizard_frame(request, tracker, StepName.LOCATION)
    untouched = not any(found.typed.texts[name] for name in ("latitude", "longitude"))
    if untouched and status == 200:
        found.typed.errors.clear()
    now = built.site_now()
    context = LocationPage(
        frame=frame,
        form=found.typed.form(NAMES),
        preview=_preview(found, tracker.state.config, now),
        zones=zones(),
        by_place=found.zone if found.location else "",
        revision=detail.site.location_revision,
        doubts=found.doubts,
    )
    return page(request, context, block=block, status=status)


def _preview(found: Read, config: TrackerConfig, now: datetime) -> LocationPreview | None:
    place = found.location
    if place is None:
        return None
    midnight = datetime.combine(day_in(found.zone, now), time(), zone_of(found.zone))
    events = day_events(config.algorithm, place, midnight, midnight + timedelta(days=1))
    noon_deg = events.transit_elevation_deg
    return LocationPreview(
        is_pair=found.is_pair,
        x=10 * (place.longitude_deg + 180),
        y=10 * (90 - place.latitude_deg),
        normal=normal_form(place),
        half=_half(place),
        zone=found.zone,
        date=local(now, found.zone, "%Y-%m-%d"),
        rise=_time(events.rise, found.zone),
        transit=_time(events.transit, found.zone),
        set=_time(events.set, found.zone),
        noon_elevation="–" if noon_deg is None else f"{decimals(noon_deg, 1)}°",
        polar=_polar(events),
        sun_now=_sun_now(place, config, now),
        if_swapped="" if swapped(place) is None else _sun_now(swapped(place) or place, config, now),
    )


def _sun_now(place: Location, config: TrackerConfig, now: datetime) -> Message:
    """Return where somebody at a place sees the sun, nothing while the clock shows years of no known sun."""
    try:
        sun = sun_position(config.algorithm, place, now)
    except InstantRefused:
        return NOTHING
    height_deg = sun.apparent_elevation_deg
    if height_deg <= 0.0:
        return say("{height_deg}° below the horizon", height_deg=with_format(abs(height_deg), ".0f"))
    return say(
        "{height_deg}° high in the {azimuth_deg}, at azimuth {azimuth_deg2}°",
        height_deg=with_format(height_deg, ".0f"),
        azimuth_deg=compass(sun.azimuth_deg),
        azimuth_deg2=with_format(sun.azimuth_deg, ".0f"),
    )


def normal_form(place: Location) -> str:
    """Return a place in degrees, minutes and seconds, as on a map."""
    return f"{_dms(place.latitude_deg, 'NS')}  {_dms(place.longitude_deg, 'EW')}"


def _dms(value_deg: float, sides: str) -> str:
    total = round(abs(value_deg) * 36000)
    minutes, tenths = divmod(total, 600)
    side = pgettext("compass", sides[value_deg < 0])
    return f"{minutes // 60}° {minutes % 60:02d}′ {formatted('%04.1f', tenths / 10)}″ {side}"


def _half(place: Location) -> Message:
    if place.latitude_deg >= 0:
        if place.longitude_deg >= 0:
            return N_("northern hemisphere, east of Greenwich")
        return N_("northern hemisphere, west of Greenwich")
    if place.longitude_deg >= 0:
        return N_("southern hemisphere, east of Greenwich")
    return N_("southern hemisphere, west of Greenwich")


def _time(at: datetime | None, zone: str) -> str:
    return "–" if at is None else local(at, zone, "%H:%M")


def _polar(events: SunEvents) -> Message:
    match events.polar:
        case PolarDay.DAY:
            return N_("The sun does not set today: polar day.")
        case PolarDay.NIGHT:
            return N_("The sun does not rise today: polar night.")
        case None:
            return NOTHING
