"""What is typed on the protections page, read into the domain's words and back."""

from typing import Any

from pydantic import ValidationError

from app.adapter import adapter
from app.tracker.protections.config import PROTECTED, ProtectionConfig
from app.tracker.protections.words import Facing, Reaction, StowName
from app.web.protection_contexts import Group, Setting
from app.web.ui.forms import Typed, Unreadable

NUMBERS: dict[str, tuple[str, str, float, float, str]] = {
    "wind.gust_mps": ("Gust threshold", "m/s", 1, 60, "Highest wind speed over 3 s."),
    "wind.mean_mps": ("Mean-wind threshold", "m/s", 1, 60, "Over 10 minutes."),
    "wind.hysteresis_mps": ("Release hysteresis", "m/s", 0, 20, "Below both thresholds by this much."),
    "wind.resume_after_s": ("Release delay", "s", 10, 86_400, "Then tracking resumes."),
    "wind.bad_after_s": (
        "Sensor-fault delay",
        "s",
        0,
        3600,
        "Reading missing, stale, frozen, or implausible.",
    ),
    "snow.load_kg": ("Snow-load threshold", "kg", 0.1, 10_000, "On one panel; 4 kg on 4 m² is 1 cm of snow."),
    "snow.hold_s": ("Trigger delay", "s", 1, 86_400, "Without interruption."),
    "snow.hysteresis_kg": ("Release hysteresis", "kg", 0, 1000, "Then tracking resumes."),
    "snow.bad_after_s": (
        "Sensor-fault delay",
        "s",
        0,
        3600,
        "Reading missing, stale, frozen, or implausible.",
    ),
    "light.threshold_wm2": ("Low-light threshold", "W/m²", 0.1, 1000, "The panel holds its position."),
    "light.hold_s": ("Trigger delay", "s", 1, 86_400, "Without interruption."),
    "light.hysteresis_wm2": ("Release hysteresis", "W/m²", 0, 500, "Then tracking resumes immediately."),
    "light.bad_after_s": (
        "Sensor-fault delay",
        "s",
        0,
        3600,
        "Reading missing, stale, frozen, or implausible.",
    ),
    "warning_s": ("Warning time", "s", 0, 60, "Countdown and horn; 0 switches the warning off."),
}
TITLES = {
    "wind": ("Wind", "Strong wind stows the panel immediately; tracking resumes after the release delay."),
    "snow": ("Snow", "A snow load moves the panel to its snow stow position, unless the wind is strong."),
    "light": ("Low light", "In low light, the panel holds its position."),
}
REACTIONS = (
    (Reaction.IGNORE.value, "Ignore"),
    (Reaction.WARN.value, "Warn"),
    (Reaction.HOLD.value, "Hold position"),
    (Reaction.STOW.value, "Stow panel"),
)
FACINGS = (
    (Facing.ANYTHING.value, "None: azimuth unchanged"),
    (Facing.EDGE.value, "Panel edge"),
    (Facing.BACK.value, "Panel back"),
)
STOW_TITLES = (
    (StowName.WIND.value, "Wind"),
    (StowName.SNOW.value, "Snow"),
    (StowName.HAIL.value, "Hail"),
    (StowName.CLEANING.value, "Cleaning"),
    (StowName.MAINTENANCE.value, "Maintenance"),
)
USUAL_STOWS = {name: f"{PROTECTED.stows.place(StowName(name)).elevation_deg:g}" for name, _ in STOW_TITLES}
CHECKS = ("enabled", "required")
GROUPS = tuple(TITLES)


def field_name(path: str) -> str:
    """Return the name of a form field for a setting."""
    return path.replace(".", "_")


def names() -> tuple[str, ...]:
    """Return every field of the form."""
    checks = [f"{group}_{check}" for group in GROUPS for check in (*CHECKS, "bad")]
    stows = [f"{name}_stow_{part}" for name, _ in STOW_TITLES for part in ("elevation", "azimuth")]
    return (*map(field_name, NUMBERS), *checks, *stows, "wind_facing")


def groups() -> tuple[Group, ...]:
    """Return the three protections with their settings."""
    return tuple(
        Group(name, title, text, _settings(f"{name}."), REACTIONS[: 3 if name == "light" else 4])
        for name, (title, text) in TITLES.items()
    )


def fixed() -> tuple[Setting, ...]:
    """Return the settings that belong to no protection."""
    return _settings("warning")


def texts(config: ProtectionConfig) -> dict[str, str]:
    """Return a tracker's protections as the form shows them."""
    found = {field_name(path): f"{_value(config, path):g}" for path in NUMBERS}
    for group in GROUPS:
        limits = getattr(config, group)
        found |= {f"{group}_{check}": "yes" if getattr(limits, check) else "" for check in CHECKS}
        found[f"{group}_bad"] = limits.bad.value
    for name, _ in STOW_TITLES:
        place = config.stows.place(StowName(name))
        found[f"{name}_stow_elevation"] = f"{place.elevation_deg:g}"
        found[f"{name}_stow_azimuth"] = "" if place.azimuth_deg is None else f"{place.azimuth_deg:g}"
    return found | {"wind_facing": config.wind.facing.value}


def read(typed: Typed) -> ProtectionConfig | None:
    """Return the typed protections, None while anything in them is wrong."""
    found: dict[str, Any] = {group: _limits(typed, group) for group in GROUPS}
    found["wind"]["facing"] = typed.read("wind_facing", _facing, Facing.ANYTHING)
    found["stows"] = {name: _place(typed, name, title) for name, title in STOW_TITLES}
    found["warning_s"] = _number(typed, "warning_s")
    if typed.errors:
        return None
    try:
        return adapter(ProtectionConfig).validate_python(found)
    except ValidationError as error:
        for one in error.errors():
            where = str(one["loc"][0]) if one["loc"] else "wind"
            first = next(field_name(path) for path in NUMBERS if path.startswith(where))
            typed.errors[first] = one["msg"].removeprefix("Value error, ")
        return None


def _limits(typed: Typed, group: str) -> dict[str, Any]:
    found: dict[str, Any] = {
        path.removeprefix(f"{group}."): _number(typed, path)
        for path in NUMBERS
        if path.startswith(f"{group}.")
    }
    found |= {check: bool(typed.texts.get(f"{group}_{check}")) for check in CHECKS}
    return found | {"bad": typed.read(f"{group}_bad", _reaction, Reaction.WARN)}


def _place(typed: Typed, name: str, title: str) -> dict[str, float | None]:
    elevation_deg = typed.number(f"{name}_stow_elevation", f"{title}, elevation", 0, 90)
    azimuth = f"{name}_stow_azimuth"
    if not typed.texts.get(azimuth, "").strip():
        return {"elevation_deg": elevation_deg, "azimuth_deg": None}
    return {
        "elevation_deg": elevation_deg,
        "azimuth_deg": typed.number(azimuth, f"{title}, azimuth", 0, 360),
    }


def _number(typed: Typed, path: str) -> float:
    label, _, least, most, _ = NUMBERS[path]
    title = TITLES.get(path.split(".")[0], ("Warning", ""))[0]
    return typed.number(field_name(path), f"{title}: {label.lower()}", least, most)


def _settings(start: str) -> tuple[Setting, ...]:
    return tuple(
        Setting(
            field_name(path), label, unit, f"{text} {least:g} to {most:g}, usual {_value(PROTECTED, path):g}."
        )
        for path, (label, unit, least, most, text) in NUMBERS.items()
        if path.startswith(start)
    )


def _value(config: ProtectionConfig, path: str) -> float:
    found: Any = config
    for name in path.split("."):
        found = getattr(found, name)
    return float(found)


def _reaction(text: str) -> Reaction:
    if text not in list(Reaction):
        raise Unreadable("Choose the sensor-fault reaction from the list.")
    return Reaction(text)


def _facing(text: str) -> Facing:
    if text not in list(Facing):
        raise Unreadable("Choose the orientation to wind from the list.")
    return Facing(text)
