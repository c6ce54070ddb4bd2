"""Step 1: where the tracker stands, checked against today's sun and a map before it is saved."""

from dataclasses import dataclass, replace
from datetime import datetime
from functools import cache
from typing import Annotated
from zoneinfo import available_timezones

from fastapi import Form, Query
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import SetLocation, SiteDetail
from app.sun.position import Algorithm, Location
from app.tracker.memory.memory import SiteState, StepName
from app.tracker.values.typed_numbers import written
from app.web.features.site.location_contexts import LocationPage, LocationPreview, PlaceQuestion
from app.web.features.site.place import Doubt, place_doubts, refuse_before_asking, zone_at
from app.web.features.site.place_preview import preview_of, sun_rows
from app.web.features.site.place_question import instead_of, likeliest, question, text_of
from app.web.features.site.site_map import LARGER_DEG, site_map
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell import coordinates
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.formats import offset
from app.web.shell.forms import Typed
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page, wants_block
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
    asked_for: Annotated[str, MAY_BE_ABSENT] = ""
    instead: Annotated[str, MAY_BE_ABSENT] = ""


@dataclass(frozen=True, slots=True)
class Read:
    """What the form means: a place and its zone, unless there are errors."""

    typed: Typed
    location: Location | None
    zone: str
    doubts: tuple[Doubt, ...] = ()
    is_pair: bool = False

    @property
    def is_asked_for(self) -> bool:
        """Return whether the question that the form has is about this location."""
        asked_for = self.typed.texts["asked_for"]
        return self.location is not None and asked_for == text_of(self.location, self.zone)

    @property
    def is_asked(self) -> bool:
        """Return whether it must be confirmed that the location is right, and was not yet.

        Who confirms without a question, as a program does, confirms what is sent.
        """
        has_answer = self.is_asked_for or not self.typed.texts["asked_for"]
        return bool(self.doubts) and not (has_answer and self.typed.texts["sun_there"] == "yes")


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
    found = read(typed)
    if found.is_asked_for:
        found = _doubted(found, detail.site, built)
    return _answer(request, tracker_id, detail, found, built, block="preview")


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    tracker_id: str, typed: Annotated[LocationForm, Form()], press: PressDep, built: PanelDep
) -> Response:
    """Save the location and go on to the clock."""
    detail = await built.machine.detail()
    found = _doubted(_meant(typed), detail.site, built)
    if found.location is not None and found.is_asked:
        refuse_before_asking(found.location, detail, built.machine.latest())
    if found.location is None or found.is_asked:
        return _answer(press.request, tracker_id, detail, found, built, block="step", status=422)
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


def _meant(form: LocationForm) -> Read:
    """Return what was typed, or the location that an answer to the question names instead."""
    found = read(form)
    if not form.instead or found.location is None:
        return found
    texts = instead_of(found.location, form.instead) | {"sun_there": "", "asked_for": ""}
    return read(form.model_copy(update=texts))


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
    untouched = not any(found.typed.texts[name] for name in ("latitude", "longitude"))
    if untouched and status == 200:
        found.typed.errors.clear()
    now, algorithm = built.site_now(), tracker.state.config.algorithm
    likely = likeliest(found.doubts) if found.is_asked else None
    mistake = likely.mistake if likely else None
    places = [place for place in (found.location, likely.other if likely else None) if place]
    rows = sun_rows(places, mistake, algorithm, now)
    context = LocationPage(
        frame=wizard_frame(request, tracker, StepName.LOCATION),
        form=found.typed.form(NAMES),
        preview=_preview(found, algorithm, now),
        map=site_map(algorithm, now, places, mistake, is_asked=found.is_asked),
        larger=site_map(algorithm, now, places, mistake, is_asked=found.is_asked, width_deg=LARGER_DEG),
        rows=rows,
        zones=zones(),
        by_place=f"{found.zone} {offset(now, found.zone)}" if found.location else "",
        question=_question(found, detail.site, built, is_compared=not all(row.is_down for row in rows)),
        is_part=block is not None and wants_block(request),
    )
    return page(request, context, block=block, status=status)


def _preview(found: Read, algorithm: Algorithm, now: datetime) -> LocationPreview | None:
    if found.location is None:
        return None
    return preview_of(found.location, found.zone, algorithm, now, is_pair=found.is_pair)


def _question(found: Read, site: SiteState, built: Panel, *, is_compared: bool) -> PlaceQuestion | None:
    """Return what is asked about a location, None where nothing is or it was answered."""
    if found.location is None or not found.is_asked:
        return None

    def doubts_of(other: Location) -> tuple[Doubt, ...]:
        zone = found.typed.texts["time_zone"] or proposed(other.latitude_deg, other.longitude_deg)
        return _doubted(replace(found, location=other, zone=zone), site, built).doubts

    return question(found.location, found.zone, found.doubts, doubts_of, is_compared=is_compared)
