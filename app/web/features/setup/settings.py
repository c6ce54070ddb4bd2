"""What an engineer sets for one tracker: name, drive, limits, speeds, tracking; and removing it."""

from dataclasses import replace
from typing import Annotated, Any

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.adapter import adapter
from app.base.message import N_, say
from app.base.permission import Permission
from app.link.messages import ConfigureTracker, RemoveTracker, TrackerDetail
from app.link.settings_orders import UndoSettings
from app.sun.position import Algorithm
from app.tracker.motion.limit_change import LimitReview
from app.tracker.mounts.capabilities import axis_title
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.settings.declared import Declared, called, declared
from app.web.api.limit_review import limit_review, must_ask, require_proof
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import ALGORITHMS, ReviewQuestion, SettingRow, SettingsPage
from app.web.shell.deps import MachineDep, panel
from app.web.shell.forms import Typed, Unreadable, sent
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.setting_forms import below, put, row, rows, texts, typed_value, validated
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/settings")


DRIVE = ("drive", "profile", "host", "port", "unit")
TRACKER = declared(TrackerConfig)
ON_DRIVE = declared(DriveConfig)
NAME = TRACKER["name"]
TRACKING = (
    *(one for path, one in TRACKER.items() if "." not in path and path not in ("name", "strategy")),
    *(one for path, one in TRACKER.items() if path.startswith("park.")),
)


@router.get("")
@needs(Permission.READ)
async def settings(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the stored settings."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    return _answer(request, tracker, Typed(_texts(tracker.state.config)))


@router.post("")
@needs(Permission.CONFIGURE)
async def save(request: Request, tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Save all settings, or none of them."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    found = await sent(request)
    wanted = _read(found, tracker.state.config)
    if wanted is None:
        return _answer(press.request, tracker, found, status=422)
    require_proof(press.request, tracker.state.config, wanted)
    asked = await run_in_threadpool(limit_review, panel(press.request).machine.latest(), tracker, wanted)
    if await must_ask(press.request, tracker_id, asked):
        return _answer(press.request, tracker, found, block="review", asked=asked)
    await press.send(ConfigureTracker(wanted))
    return press.answer(N_("The settings are saved."))


@router.post("/undo")
@needs(Permission.CONFIGURE, proven=True)
async def undo(tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Set the tracker as it was before its settings were changed last; ask first as `save` does."""
    detail = await machine.detail()
    tracker, former = tracker_of(detail, tracker_id), detail.site.former.get(tracker_id)
    if former is not None:
        wanted = replace(former, drive=tracker.state.config.drive)
        asked = await run_in_threadpool(limit_review, machine.latest(), tracker, wanted)
        if await must_ask(press.request, tracker_id, asked):
            return page(press.request, ReviewQuestion(asked))
    await press.send(UndoSettings(tracker_id))
    root = f"/trackers/{tracker_id}/"
    return go(press.request, press.back if press.back.startswith(root) else f"{root}settings")


@router.post("/remove")
@needs(Permission.CONFIGURE)
async def remove(
    tracker_id: str, press: PressDep, typed_id: Annotated[str, Form(max_length=64)] = ""
) -> Response:
    """Remove the tracker after its id was typed."""
    if typed_id.strip() != tracker_id:
        raise NotAcceptable(
            say("Type {tracker_id} into the field to remove this tracker.", tracker_id=tracker_id)
        )
    await press.send(RemoveTracker(tracker_id))
    return go(press.request, "/")


def _of_axis(axis: Axis) -> tuple[Declared, ...]:
    """Return the numbers that are set for one axis."""
    return tuple(one for one in below(TrackerConfig, axis) if one.is_number)


def _row(one: Declared) -> SettingRow:
    """Return the field of a setting; algorithms have their errors beside their names."""
    return replace(row(one), choices=ALGORITHMS) if one.kind is Algorithm else row(one)


def _texts(config: TrackerConfig) -> dict[str, str]:
    drive = config.drive
    values = (drive.kind.value, drive.profile, drive.host, str(drive.port), str(drive.unit))
    axes = (one for axis in Axis for one in _of_axis(axis))
    return dict(zip(DRIVE, values, strict=True)) | texts(config, (NAME, *TRACKING, *axes))


def _read(typed: Typed, config: TrackerConfig) -> TrackerConfig | None:
    """Return the typed configuration, None while anything in it is wrong."""
    wanted: dict[str, Any] = adapter(TrackerConfig).dump_python(config)
    for one in (NAME, *TRACKING):
        put(wanted, one.path, typed_value(typed, one))
    for axis in config.mount.axes:
        title = axis_title(config.mount, axis).capitalize()
        for one in _of_axis(axis):
            put(wanted, one.path, typed_value(typed, one, called(title, one.label)))
    wanted["drive"] = _drive(typed, config.drive)
    return None if typed.errors else validated(typed, TrackerConfig, wanted)


def _drive(typed: Typed, stored: DriveConfig) -> DriveConfig:
    kind = typed.read("drive", _drive_kind, DriveKind.SIMULATED)
    port, unit = typed_value(typed, ON_DRIVE["port"]), typed_value(typed, ON_DRIVE["unit"])
    host, profile = typed.text("host"), typed.text("profile")
    if not host:
        typed.errors["host"] = N_("Host: give the address of the drive, such as 192.168.1.20.")
    if not profile:
        typed.errors["profile"] = N_("Profile: give the name of the drive's profile, such as simulated-plc.")
    return replace(stored, kind=kind, profile=profile, host=host, port=port, unit=unit)


def _drive_kind(text: str) -> DriveKind:
    if text not in list(DriveKind):
        raise Unreadable(N_("Drive: choose one from the list."))
    return DriveKind(text)


def _answer(
    request: Request,
    tracker: TrackerDetail,
    typed: Typed,
    *,
    block: str = "form",
    asked: LimitReview | None = None,
    status: int = 200,
) -> Response:
    frame = tracker_frame(request, tracker.state.config.tracker_id, N_("Settings"))
    mount = tracker.state.config.mount
    context = SettingsPage(
        frame=frame,
        form=typed.form(_texts(tracker.state.config)),
        mount=mount,
        name=row(NAME),
        tracking=tuple(map(_row, TRACKING)),
        axes={axis.value: rows(_of_axis(axis)) for axis in Axis},
        review=asked,
    )
    return page(request, context, block=block, status=status)
