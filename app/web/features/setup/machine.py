"""The page of the machine's own protections: limits, what follows each class of fault, forbidden regions."""

from dataclasses import replace

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import ConfigureTracker, TrackerDetail
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.web.charts.drawings import Arc
from app.web.charts.region_picture import region_picture
from app.web.charts.sunpath import arc
from app.web.features.setup import machine_forms as forms
from app.web.features.setup.protection_contexts import MachinePage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed, sent
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/machine")


@router.get("")
@needs(Permission.READ)
async def machine_protections(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show what is set."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    return _answer(request, tracker, Typed(forms.texts(tracker.state.config.machine)))


@router.post("/picture")
@needs(Permission.READ)
async def picture(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Draw the regions as they are typed; nothing is saved."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = await sent(request)
    forms.regions(typed)
    return _answer(request, tracker, typed, block="regions")


@router.post("")
@needs(Permission.CONFIGURE)
async def save(request: Request, tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Save all settings, or none of them."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = await sent(request)
    wanted = forms.read(typed)
    if wanted is None:
        return _answer(press.request, tracker, typed, status=422)
    config = tracker.state.config
    if config.mount.single_axis:
        wanted = replace(wanted, regions=config.machine.regions)
    await press.send(ConfigureTracker(replace(config, machine=wanted)))
    return go(press.request, request.url.path)


def _todays_arc(site: SiteSnapshot | None, config: TrackerConfig) -> Arc:
    if site is None or site.location is None:
        return ()
    return arc(config.algorithm, site.location, day_in(site.time_zone, site.at))


def _answer(
    request: Request, tracker: TrackerDetail, typed: Typed, *, block: str = "form", status: int = 200
) -> Response:
    config = tracker.state.config
    frame = tracker_frame(request, config.tracker_id, N_("Mechanics"))
    shown = None
    if not config.mount.single_axis:
        shown = region_picture(
            config, forms.drawable(typed), tracker.state.memory.pointing, _todays_arc(frame.site, config)
        )
    context = MachinePage(
        frame=frame,
        config=config,
        form=typed.form(forms.names()),
        settings=forms.settings(),
        faults=forms.fault_rows(),
        places=forms.places(typed),
        how=forms.HOW,
        picture=shown,
    )
    return page(request, context, block=block, status=status)
