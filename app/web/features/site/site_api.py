"""The site: its name, place and clock."""

from datetime import datetime, timedelta
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from app.base.instants import Instant
from app.base.message import N_, join, say
from app.base.permission import Permission
from app.link.messages import RenameSite, SetClock, SetLocation
from app.link.settings_orders import UndoSiteSettings
from app.sun.position import Location
from app.tracker.settings.config import LONGEST_NAME
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.reason import Reason
from app.web.api.base import CHANGED, REFUSED, TAGGED, Clean, Input, Output, api_router
from app.web.api.orders import SenderDep, listed
from app.web.api.tags import of_site, tagged, unless_changed
from app.web.features.site.clock_doubt import clock_doubt, refuse_before_asking
from app.web.features.site.place import place_doubts
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, PanelDep, SnapshotDep

router = api_router(prefix="/site", tags=["site"])
NAME = of_site(lambda site: site.name)
PLACE = of_site(lambda site: (site.location, site.time_zone))
CLOCK = of_site(lambda site: (site.clock, site.time_zone))


class SiteName(Input):
    """A new name for the site."""

    name: Annotated[str, Clean] = Field(
        min_length=1, max_length=LONGEST_NAME, examples=["Samsun solar field"]
    )


class SitePlace(Input):
    """Where the site is and which civil time it keeps."""

    latitude_deg: float = Field(ge=-90, le=90, description="North positive.", examples=[41.2867])
    longitude_deg: float = Field(ge=-180, le=180, description="East positive.", examples=[36.33])
    altitude_m: float = Field(0.0, ge=-500, le=9000, description="Above mean sea level.", examples=[4.0])
    time_zone: str = Field(
        min_length=1, max_length=64, description="IANA name.", examples=["Europe/Istanbul"]
    )
    confirmed: bool = Field(
        False,
        description="The place is right although it lies in the sea or far from the stored one, or its sun "
        "and its time zone disagree.",
    )


class StoredPlace(Output):
    """Where the site is and which civil time it keeps; null before step 1."""

    latitude_deg: float | None = Field(description="North positive.")
    longitude_deg: float | None = Field(description="East positive.")
    altitude_m: float | None = Field(description="Above mean sea level.")
    time_zone: str = Field(description="IANA name.")


class ClockChange(Input):
    """Trust the computer's clock, or make the site's clock show `at` now."""

    source: Literal["system", "manual"] = Field(examples=["system"])
    at: Instant | None = Field(None, description="What the clock shall show now; with `manual` only.")
    time_zone: str | None = Field(None, min_length=1, max_length=64, description="IANA name; None keeps it.")

    device_at: Instant | None = Field(
        None, description="What the clock of whoever asks shows now; the controller's is compared with it."
    )
    confirmed: bool = Field(
        False, description="The controller's clock is right although it differs by more than a minute."
    )

    @model_validator(mode="after")
    def _instant_with_manual(self) -> Self:
        if (self.source == "manual") != (self.at is not None):
            raise ValueError(N_("Give `at` only with the source manual, where it is required."))
        return self


class Clock(Output):
    """The site's clock and whether automatic motion may rely on it."""

    at: datetime = Field(description="What the clock shows now.")
    time_zone: str = Field(description="IANA name of the site's civil time.")
    source: str = Field(description="`system`, `manual`, or `unset` before step 2.")
    offset_s: float = Field(description="Added to the computer's clock, seconds.")
    trusted: bool
    ntp_synchronised: bool | None = Field(description="None where the computer cannot tell.")
    set_at: datetime | None
    age_s: float | None = Field(description="Seconds since the clock was set.")
    reasons: tuple[Reason, ...] = Field(description="Why it is not trusted.")
    warnings: tuple[Reason, ...] = Field(description="What is wrong with it while it is trusted still.")
    off_s: float | None = Field(
        description="By how much it is known to be fast, seconds: by NTP, by views of the sun, or by steps "
        "that nobody answers for. Null where nothing tells, or only a device differs."
    )


@router.get("", summary="The whole site now", responses=TAGGED, dependencies=[tagged(NAME)])
@needs(Permission.READ)
async def read_site(snapshot: SnapshotDep) -> SiteSnapshot:
    """Return name, location, clock, sun and every tracker at this instant; the `ETag` is that of the name."""
    return listed(snapshot)


@router.patch("", summary="Rename the site", responses=CHANGED | REFUSED, dependencies=[unless_changed(NAME)])
@needs(Permission.CONFIGURE)
async def rename_site(change: SiteName, sender: SenderDep) -> SiteSnapshot:
    """Give the site another name."""
    return listed(await sender.send(RenameSite(change.name)))


@router.post(
    "/settings/undo",
    summary="Undo the last change of the site's settings",
    responses=REFUSED,
)
@needs(Permission.CONFIGURE)
async def undo_site_settings(sender: SenderDep) -> SiteSnapshot:
    """Set name, horizon, weather and notifications as they were before the last change; once more redoes."""
    return listed(await sender.send(UndoSiteSettings()))


@router.get("/location", summary="The location", responses=TAGGED, dependencies=[tagged(PLACE)])
@needs(Permission.READ)
async def read_location(machine: MachineDep) -> StoredPlace:
    """Return what was set in step 1."""
    site = (await machine.detail()).site
    place = site.location
    if place is None:
        return StoredPlace(latitude_deg=None, longitude_deg=None, altitude_m=None, time_zone=site.time_zone)
    return StoredPlace(
        latitude_deg=place.latitude_deg,
        longitude_deg=place.longitude_deg,
        altitude_m=place.altitude_m,
        time_zone=site.time_zone,
    )


@router.put(
    "/location",
    summary="Step 1: set the location",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(PLACE)],
)
@needs(Permission.CONFIGURE)
async def set_location(
    place: SitePlace, sender: SenderDep, built: PanelDep, machine: MachineDep
) -> SiteSnapshot:
    """Store the location; the steps that depend on it are to be confirmed again.

    One that is likely to be mistaken is refused with what speaks against it until it is `confirmed`.
    """
    location = Location(place.latitude_deg, place.longitude_deg, place.altitude_m)
    before = (await machine.detail()).site.location
    doubts = place_doubts(location, place.time_zone, built.site_now(), before=before)
    if doubts and not place.confirmed:
        sentences = [doubt.sentence for doubt in doubts]
        how = N_("If the location is correct, send the request again with `confirmed`.")
        raise NotAcceptable(join(" ", (*sentences, how)))
    return listed(await sender.send(SetLocation(location, place.time_zone)))


@router.get("/clock", summary="The site's clock", responses=TAGGED, dependencies=[tagged(CLOCK)])
@needs(Permission.READ)
async def read_clock(snapshot: SnapshotDep) -> Clock:
    """Return what the clock shows, where it comes from and whether it is trusted; `ETag`: how it was set."""
    return _clock(snapshot)


@router.put(
    "/clock",
    summary="Step 2: set the clock",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(CLOCK)],
)
@needs(Permission.CONFIGURE)
async def set_clock(change: ClockChange, sender: SenderDep, built: PanelDep) -> Clock:
    """Trust the computer's clock or set the site's clock by hand.

    One that differs by more than a minute from `device_at`, or, where it is set by hand without that, from
    the computer's clock, is refused with the difference until it is `confirmed`. One that moves the site's
    clock by more than a minute is refused while a tracker tracks, or may continue by itself.
    """
    now = built.clock.system_time()
    if change.at:
        refuse_before_asking(change.at - built.site_now(), built.machine.latest())
    other = change.device_at or (now if change.at else None)
    if (doubt := clock_doubt(change.at or now, other)) and not change.confirmed:
        raise NotAcceptable(
            say(
                "{doubt} If the controller's clock is correct, send the request again with `confirmed`.",
                doubt=doubt,
            )
        )
    return _clock(await sender.send(SetClock(change.source, change.at, change.time_zone)))


def _clock(site: SiteSnapshot) -> Clock:
    state = site.clock
    age = None if state.set_at is None else (site.at - state.set_at) / timedelta(seconds=1)
    return Clock(
        at=site.at,
        time_zone=site.time_zone,
        source=state.source,
        offset_s=state.offset_s,
        trusted=state.trusted,
        ntp_synchronised=state.ntp_synchronised,
        set_at=state.set_at,
        age_s=age,
        reasons=state.reasons,
        warnings=state.warnings,
        off_s=state.off_s,
    )
