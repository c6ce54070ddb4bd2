"""Step 4: what the tracker shall do, and where it holds the axes that do not follow the sun."""

from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, Message, join, say, with_format
from app.base.permission import Permission
from app.link.messages import SiteDetail, TrackerDetail
from app.tracker.commands.commands import Move, SelectMode
from app.tracker.memory.memory import StepName
from app.tracker.mounts.capabilities import abilities, axis_title
from app.tracker.settings.config import MountKind, Orientation, TrackerConfig
from app.tracker.values.mode import Mode
from app.tracker.values.typed_numbers import written
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.contexts import ModeChoice, ModePage, OrientationPage
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.orders import Press, PressDep
from app.web.shell.render import go, page
from app.web.shell.scene import scene_now
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/mode")
CHOICES = (
    ModeChoice(Mode.DUAL, N_("Dual-axis tracking"), N_("Both axes follow the sun. Highest energy yield.")),
    ModeChoice(
        Mode.AZIMUTH, N_("Azimuth tracking"), N_("The panel turns with the sun and keeps one elevation.")
    ),
    ModeChoice(
        Mode.ELEVATION, N_("Elevation tracking"), N_("The panel tilts with the sun and keeps one azimuth.")
    ),
    ModeChoice(Mode.FIXED, N_("Fixed"), N_("The panel goes to one orientation and stays there.")),
)
LEAST_INCIDENCE = N_("The panel keeps one azimuth and tilts to the smallest angle to the sun.")
EQUATORIAL = {
    Mode.AZIMUTH: N_("The panel turns with the hour angle and keeps one declination."),
    Mode.ELEVATION: N_("The panel follows the declination through the year and keeps one hour angle."),
}
SINGLE_AXIS = N_("The axis turns the panel as near to the sun as it can.")
SINGLE_AXIS_ROWS = N_(
    "The axis turns the panel to the sun, and back from a low one, so that no row shades the next."
)
SINGLE_AXIS_FIXED = N_("The axis turns the panel as near to one orientation as it can and stays there.")
HELD = {
    Mode.FIXED: ("azimuth", "elevation"),
    Mode.AZIMUTH: ("elevation",),
    Mode.ELEVATION: ("azimuth",),
    Mode.DUAL: (),
}


class OrientationForm(BaseModel):
    """The form as it was typed; an axis that follows the sun is not asked for."""

    azimuth: Annotated[str, MAY_BE_ABSENT] = ""
    elevation: Annotated[str, MAY_BE_ABSENT] = ""


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the modes that the mount has; the first, with the highest yield, until one was chosen."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    frame = wizard_frame(request, tracker, StepName.MODE)
    memory = tracker.state.memory
    listed = choices(tracker.state.config)
    chosen = memory.mode or listed[0].mode
    return page(
        request,
        ModePage(
            frame=frame, choices=listed, chosen=chosen, saved=memory.mode, orientation=memory.orientation
        ),
    )


@router.post("")
@needs(Permission.OPERATE)
async def choose(
    tracker_id: str, press: PressDep, machine: MachineDep, mode: Annotated[str, Form(), MAY_BE_ABSENT] = ""
) -> Response:
    """Save the mode; go on to its orientation, or to the last step."""
    if mode not in list(Mode):
        raise NotAcceptable(N_("Choose one of the modes in the list."))
    await press.send(SelectMode(Mode(mode)), tracker_id)
    root = f"/trackers/{tracker_id}/commissioning"
    config = tracker_of(await machine.detail(), tracker_id).state.config
    return go(press.request, f"{root}/mode/orientation" if held(config, Mode(mode)) else f"{root}/run")


@router.get("/orientation")
@needs(Permission.READ)
async def orientation(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the angles that the chosen mode holds."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    stored = tracker.state.memory.orientation
    texts = {"azimuth": written(stored.azimuth_deg), "elevation": written(stored.elevation_deg)}
    return _orientation(request, detail, tracker, Typed(texts))


@router.post("/orientation")
@needs(Permission.READ)
async def go_there(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[OrientationForm, Form()]
) -> Response:
    """Save the angles and move the panel there."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    mode = tracker.state.memory.mode or Mode.DUAL
    found = Typed(typed.model_dump())
    wanted = _read(found, tracker, mode)
    if found.errors:
        return _orientation(press.request, detail, tracker, found, status=422)
    await _save_and_move(press, tracker_id, mode, wanted)
    return go(press.request, press.request.url.path)


async def _save_and_move(press: Press, tracker_id: str, mode: Mode, wanted: Orientation) -> None:
    key = press.key
    await press.send(SelectMode(mode, wanted), tracker_id)
    press.key = f"{key}-go" if key else None
    await press.send(Move(wanted), tracker_id)


def _read(found: Typed, tracker: TrackerDetail, mode: Mode) -> Orientation:
    config, stored = tracker.state.config, tracker.state.memory.orientation
    azimuth_deg, elevation_deg = stored.azimuth_deg, stored.elevation_deg
    asked = held(config, mode)
    if "azimuth" in asked:
        azimuth_deg = found.number("azimuth", N_("Azimuth"), 0, 360, "°")
    if "elevation" in asked:
        lowest_deg, highest_deg = _elevations(config)
        elevation_deg = found.number("elevation", N_("Elevation"), lowest_deg, highest_deg, "°")
    return Orientation(azimuth_deg, elevation_deg)


def _orientation(
    request: Request, detail: SiteDetail, tracker: TrackerDetail, typed: Typed, *, status: int = 200
) -> Response:
    mode = tracker.state.memory.mode or Mode.DUAL
    frame = wizard_frame(request, tracker, StepName.MODE)
    context = OrientationPage(
        frame=frame,
        form=typed.form(("azimuth", "elevation")),
        held=held(tracker.state.config, mode),
        choice=choice(tracker.state.config, mode),
        limits=limits_text(tracker.state.config),
        scene=scene_now(frame.site, tracker.state.config, detail.site.horizon),
    )
    return page(request, context, block="form", status=status)


def choices(config: TrackerConfig) -> tuple[ModeChoice, ...]:
    """Return the modes that a tracker's mount has, the one with the most energy first."""
    titles = abilities(config.mount).modes
    return tuple(
        ModeChoice(one.mode, titles[one.mode], _text(config, one), held(config, one.mode))
        for one in CHOICES
        if one.mode in titles
    )


def choice(config: TrackerConfig, mode: Mode) -> ModeChoice:
    """Return a mode's label and what it does on a tracker's mount."""
    plain = next(one for one in CHOICES if one.mode is mode)
    return ModeChoice(mode, abilities(config.mount).modes.get(mode, plain.label), _text(config, plain))


def held(config: TrackerConfig, mode: Mode) -> tuple[str, ...]:
    """Return which angles a mode holds; other mounts than azimuth and elevation hold a whole direction."""
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return HELD[mode]
    follows = mode is Mode.DUAL or (config.mount.single_axis and mode is not Mode.FIXED)
    return () if follows else HELD[Mode.FIXED]


def _text(config: TrackerConfig, plain: ModeChoice) -> str:
    """Return what a mode does on a mount."""
    mount = config.mount
    if mount.single_axis:
        if plain.mode is Mode.FIXED:
            return SINGLE_AXIS_FIXED
        return SINGLE_AXIS_ROWS if mount.rows else SINGLE_AXIS
    if mount.kind is MountKind.EQUATORIAL:
        return EQUATORIAL.get(plain.mode, plain.text)
    return LEAST_INCIDENCE if plain.mode is Mode.ELEVATION and mount.least_incidence else plain.text


def _elevations(config: TrackerConfig) -> tuple[float, float]:
    """Return between which elevations a held orientation may lie."""
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        return config.elevation.minimum_deg, config.elevation.maximum_deg
    return 0.0, 90.0


def limits_text(config: TrackerConfig) -> Message:
    """Return the soft limits as a sentence."""
    parts = [
        say(
            "{mount} {minimum_deg} to {maximum_deg}°",
            mount=axis_title(config.mount, axis),
            minimum_deg=with_format(config.axis(axis).minimum_deg, "g"),
            maximum_deg=with_format(config.axis(axis).maximum_deg, "g"),
        )
        for axis in config.mount.axes
    ]
    return say("Soft limits: {parts}.", parts=join(", ", parts))
