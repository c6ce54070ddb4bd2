"""What an engineer sets for one tracker: name, drive, limits, speeds, tracking; and removing it."""

from dataclasses import replace
from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import ConfigureTracker, RemoveTracker, TrackerDetail
from app.link.settings_orders import UndoSettings
from app.sun.position import Algorithm
from app.tracker.axes import Axis, AxisConfig
from app.tracker.config import DriveConfig, DriveKind, NightBehaviour, Orientation, TrackerConfig
from app.tracker.limit_change import LimitReview
from app.tracker.mounts.capabilities import axis_title
from app.web.contexts import SettingsPage
from app.web.deps import MachineDep, panel
from app.web.errors import NotAcceptable
from app.web.late_routes import page_router
from app.web.limit_review import limit_review, must_ask, require_proof
from app.web.ui.forms import Typed, Unreadable
from app.web.ui.frame import tracker_frame
from app.web.ui.orders import PressDep
from app.web.ui.render import go, page
from app.web.ui.settings_words import SETTINGS
from app.web.ui.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/settings")


class SettingsForm(BaseModel):
    """The form as it was typed; all texts."""

    name: str = ""
    drive: str = ""
    profile: str = ""
    host: str = ""
    port: str = ""
    unit: str = ""
    azimuth_minimum: str = ""
    azimuth_maximum: str = ""
    azimuth_speed: str = ""
    azimuth_acceleration: str = ""
    azimuth_slow: str = ""
    azimuth_fast: str = ""
    elevation_minimum: str = ""
    elevation_maximum: str = ""
    elevation_speed: str = ""
    elevation_acceleration: str = ""
    elevation_slow: str = ""
    elevation_fast: str = ""
    algorithm: str = ""
    refraction: str = ""
    deadband: str = ""
    in_position: str = ""
    following_error: str = ""
    night: str = ""
    park_azimuth: str = ""
    park_elevation: str = ""


@router.get("")
async def settings(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the stored settings."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    return _answer(request, tracker, Typed(_texts(tracker.state.config)))


@router.post("")
async def save(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[SettingsForm, Form()]
) -> Response:
    """Save all settings, or none of them."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    found = Typed(typed.model_dump())
    wanted = _read(found, tracker.state.config)
    if wanted is None:
        return _answer(press.request, tracker, found, status=422)
    require_proof(press.request, tracker.state.config, wanted)
    asked = limit_review(panel(press.request).machine.latest(), tracker, wanted)
    if await must_ask(press.request, asked):
        return _answer(press.request, tracker, found, block="review", asked=asked)
    await press.send(ConfigureTracker(wanted))
    return press.answer("The settings are saved.")


@router.post("/undo")
async def undo(tracker_id: str, press: PressDep) -> Response:
    """Set the tracker as it was before its settings were changed last."""
    await press.send(UndoSettings(tracker_id))
    root = f"/trackers/{tracker_id}/"
    return go(press.request, press.back if press.back.startswith(root) else f"{root}settings")


@router.post("/remove")
async def remove(
    tracker_id: str, press: PressDep, typed_id: Annotated[str, Form(max_length=64)] = ""
) -> Response:
    """Remove the tracker after its id was typed."""
    if typed_id.strip() != tracker_id:
        raise NotAcceptable(f"Type {tracker_id} into the field to remove this tracker.")
    await press.send(RemoveTracker(tracker_id))
    return go(press.request, "/")


def _texts(config: TrackerConfig) -> dict[str, str]:
    drive = config.drive
    return {
        "name": config.name,
        "drive": drive.kind.value,
        "profile": drive.profile,
        "host": drive.host,
        "port": str(drive.port),
        "unit": str(drive.unit),
        **_axis_texts("azimuth", config.azimuth),
        **_axis_texts("elevation", config.elevation),
        "algorithm": config.algorithm.value,
        "refraction": "yes" if config.refraction else "",
        "deadband": f"{config.deadband_deg:g}",
        "in_position": f"{config.in_position_deg:g}",
        "following_error": f"{config.following_error_deg:g}",
        "night": config.night.value,
        "park_azimuth": f"{config.park.azimuth_deg:g}",
        "park_elevation": f"{config.park.elevation_deg:g}",
    }


def _axis_texts(name: str, axis: AxisConfig) -> dict[str, str]:
    values = {
        "minimum": axis.minimum_deg,
        "maximum": axis.maximum_deg,
        "speed": axis.speed_dps,
        "acceleration": axis.acceleration_dps2,
        "slow": axis.jog_slow_dps,
        "fast": axis.jog_fast_dps,
    }
    return {f"{name}_{key}": f"{value:g}" for key, value in values.items()}


def _read(typed: Typed, config: TrackerConfig) -> TrackerConfig | None:
    """Return the typed configuration, None while anything in it is wrong."""
    name = typed.read("name", _name, "")
    axes = {
        axis: _axis(typed, axis, axis_title(config.mount, axis), config.axis(axis))
        for axis in config.mount.axes
    }
    drive = _drive(typed, config.drive)
    park = Orientation(
        typed.number("park_azimuth", "Park azimuth", 0, 360),
        typed.number("park_elevation", "Park elevation", 0, 90),
    )
    wanted = replace(
        config,
        name=name,
        azimuth=axes[Axis.AZIMUTH],
        elevation=axes.get(Axis.ELEVATION, config.elevation),
        drive=drive,
        park=park,
        refraction=bool(typed.texts.get("refraction")),
        algorithm=typed.read("algorithm", _algorithm, Algorithm.PSA),
        night=typed.read("night", _night, NightBehaviour.SUNRISE),
        deadband_deg=typed.number("deadband", "Deadband", 0.01, 10),
        in_position_deg=typed.number("in_position", "In-position tolerance", 0.01, 5),
        following_error_deg=typed.number("following_error", "Following error", 0.1, 20),
    )
    return None if typed.errors else wanted


def _name(text: str) -> str:
    if not text or len(text) > 80:
        raise Unreadable("Name: give the tracker a name of at most 80 characters.")
    return text


def _algorithm(text: str) -> Algorithm:
    if text not in list(Algorithm):
        raise Unreadable("Sun algorithm: choose one from the list.")
    return Algorithm(text)


def _night(text: str) -> NightBehaviour:
    if text not in list(NightBehaviour):
        raise Unreadable("Night: choose one from the list.")
    return NightBehaviour(text)


def _axis(typed: Typed, name: str, title: str, stored: AxisConfig) -> AxisConfig:
    label = title.capitalize()
    values = (
        typed.number(f"{name}_minimum", f"{label} lower limit", -360, 360),
        typed.number(f"{name}_maximum", f"{label} upper limit", -360, 720),
        typed.number(f"{name}_speed", f"{label} rated speed", 0.01, 60),
        typed.number(f"{name}_acceleration", f"{label} acceleration", 0.01, 100),
        typed.number(f"{name}_slow", f"{label} slow jog speed", 0.01, 60),
        typed.number(f"{name}_fast", f"{label} fast jog speed", 0.01, 60),
    )
    if any(field.startswith(f"{name}_") for field in typed.errors):
        return stored
    try:
        return AxisConfig(*values, stored.actuator)
    except ValueError as error:
        typed.errors[f"{name}_minimum"] = f"{label}: {error}"
        return stored


def _drive(typed: Typed, stored: DriveConfig) -> DriveConfig:
    kind = typed.read("drive", _drive_kind, DriveKind.SIMULATED)
    port = typed.whole("port", "Port", 1, 65535)
    unit = typed.whole("unit", "Unit", 0, 255)
    host, profile = typed.texts["host"].strip(), typed.texts["profile"].strip()
    if not host:
        typed.errors["host"] = "Host: give the address of the drive, such as 192.168.1.20."
    if not profile:
        typed.errors["profile"] = "Profile: give the name of the drive's profile, such as simulated-plc."
    return replace(stored, kind=kind, profile=profile, host=host, port=port, unit=unit)


def _drive_kind(text: str) -> DriveKind:
    if text not in list(DriveKind):
        raise Unreadable("Drive: choose one from the list.")
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
    frame = tracker_frame(request, tracker.state.config.tracker_id, "Settings")
    mount = tracker.state.config.mount
    form = typed.form(SettingsForm.model_fields)
    hints = {name: words.hint for name, words in SETTINGS.items()}
    context = SettingsPage(frame=frame, form=form, mount=mount, hints=hints, review=asked)
    return page(request, context, block=block, status=status)
