"""Recorded shows, days and simulations: the list, the player, and running one again on the machine."""

from typing import Annotated
from urllib.parse import quote, urlencode

from fastapi import Query
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.base.message import N_
from app.base.permission import Permission
from app.base.zones import zone_of
from app.link.messages import DeleteRecording, UnknownRecording
from app.store.store import Reader
from app.sun.position import Algorithm
from app.tracker.memory.recording import RecordingInfo, RecordingKind
from app.tracker.settings.axes import AZIMUTH_DEFAULT, ELEVATION_DEFAULT
from app.tracker.values.typed_numbers import written
from app.web.charts.sunpath import diagram_of, sector
from app.web.features.shows.show_plan import LONGEST_MIN
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Forward, Frame, Link, PlayerPage, RecordingsPage
from app.web.shell.deps import ReaderDep
from app.web.shell.formats import local
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.scene import scene_recorded

router = page_router(prefix="/recordings")
SHOWN = 200
WHOLE_SKY = sector(AZIMUTH_DEFAULT, ELEVATION_DEFAULT)
SHOW_SPEEDS = (1, 2, 5, 10)
DAY_SPEEDS = (60, 300, 900, 3600)
LONG_S = 3 * 3600


@router.get("")
@needs(Permission.READ)
def recordings(request: Request, reader: ReaderDep, kind: str = "", show: str = "") -> Response:
    """Show what was recorded, newest first; of a show, play what was recorded of it last."""
    if (last := _last_of(reader, show)) is not None:
        return RedirectResponse(f"/recordings/{quote(last.recording_id)}", 303)
    kind = RecordingKind.SHOW if show else kind
    chosen = RecordingKind(kind) if kind in list(RecordingKind) else None
    context = RecordingsPage(
        frame=site_frame(request, N_("Recordings")),
        recordings=tuple(reader.recordings(kind=chosen, limit=SHOWN)),
        chosen=chosen or "",
    )
    return page(request, context)


@router.get("/{recording_id}")
@needs(Permission.READ)
def player(
    request: Request,
    recording_id: str,
    reader: ReaderDep,
    with_: Annotated[str | None, Query(alias="with")] = None,
) -> Response:
    """Play one recording, and another one laid over it."""
    info = _stored(reader, recording_id)
    speeds = DAY_SPEEDS if info.duration_s > LONG_S else SHOW_SPEEDS
    on = info.sun_start.astimezone(zone_of(info.time_zone)).date()
    algorithm = Algorithm(info.algorithm)
    context = PlayerPage(
        frame=_frame(request, info),
        info=info,
        other=_stored(reader, with_) if with_ else None,
        others=_others(reader, info),
        diagram=diagram_of(info.location, info.time_zone, on, algorithm, WHOLE_SKY, info.horizon),
        scene=scene_recorded(info, on),
        speeds=speeds,
        speed=speeds[0],
    )
    return page(request, context)


@router.post("/{recording_id}/delete")
@needs(Permission.CONFIGURE)
async def delete(recording_id: str, press: PressDep) -> Response:
    """Delete a recording that is not running."""
    await press.send(DeleteRecording(recording_id))
    return go(press.request, "/recordings")


def _frame(request: Request, info: RecordingInfo) -> Frame:
    again = None
    if info.kind is not RecordingKind.DAY:
        again = Forward(N_("Run again"), f"/trackers/{info.tracker_id}/show?{urlencode(_plan(info))}")
    return site_frame(request, info.title, back=Link(N_("Recordings"), "/recordings"), forward=again)


def _plan(info: RecordingInfo) -> dict[str, str]:
    """Return the form of a show over the same stretch of sun time; a day's length is left to the page."""
    zone = info.time_zone
    is_show = info.kind is RecordingKind.SHOW
    plan = {
        "date": local(info.sun_start, zone, "%Y-%m-%d"),
        "start": local(info.sun_start, zone, "%H:%M:%S"),
        "end": local(info.sun_end, zone, "%H:%M:%S"),
    }
    return plan | {"minutes": written(info.duration_s / 60, LONGEST_MIN, 6)} if is_show else plan


def _last_of(reader: Reader, show_id: str) -> RecordingInfo | None:
    """Return the newest recording of a planned show, None where there is none."""
    kept = reader.show(show_id) if show_id else None
    if kept is None:
        return None
    stretch = (kept.plan.begin_at, kept.plan.end_at)
    shows = reader.recordings(kind=RecordingKind.SHOW, tracker_id=kept.tracker_id, limit=SHOWN)
    return next((one for one in shows if (one.sun_start, one.sun_end) == stretch), None)


def _others(reader: Reader, info: RecordingInfo) -> tuple[RecordingInfo, ...]:
    return tuple(one for one in reader.recordings(limit=SHOWN) if one.recording_id != info.recording_id)


def _stored(reader: Reader, recording_id: str) -> RecordingInfo:
    info = reader.recording(recording_id)
    if info is None:
        raise UnknownRecording(recording_id)
    return info
