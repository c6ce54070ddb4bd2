"""The form of a mount: what is stored as texts, and what was typed as settings."""

from dataclasses import replace
from math import ceil, floor

from app.base.angles import wrap360
from app.base.message import N_, say, told_by, with_format
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import aim
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, Rows, TrackerConfig
from app.tracker.settings.mechanisms import MECHANISMS
from app.tracker.settings.transmission import LinearActuator, Point
from app.tracker.values.typed_numbers import written
from app.web.shell.forms import Typed, Unreadable

NO_ACTUATOR, OWN_POINTS = "none", "own"
AXES = {"first": Axis.AZIMUTH, "second": Axis.ELEVATION}
POINTS = {
    "base_x": N_("Base x"),
    "base_y": N_("Base y"),
    "base_z": N_("Base z"),
    "joint_x": N_("Joint x"),
    "joint_y": N_("Joint y"),
    "joint_z": N_("Joint z"),
}
SIZES = {"retracted": N_("Retracted length"), "travel": N_("Stroke"), "speed": N_("Speed")}
FIELDS = (
    *("axis_azimuth", "axis_tilt", "panel_tilt", "least_incidence", "rows", "ratio", "slope"),
    *(f"{prefix}_{name}" for prefix in AXES for name in ("actuator", "at", *POINTS, *SIZES)),
)
FARTHEST_MM = 100_000.0


def texts(config: TrackerConfig) -> dict[str, str]:
    """Return a stored mount as the texts of the form."""
    mount = config.mount
    rows = mount.rows or Rows(0.4)
    found = {
        "axis_azimuth": written(mount.axis_azimuth_deg),
        "axis_tilt": written(mount.axis_tilt_deg),
        "panel_tilt": written(mount.panel_tilt_deg),
        "least_incidence": "yes" if mount.least_incidence else "",
        "rows": "yes" if mount.rows else "",
        "ratio": written(rows.ground_coverage_ratio),
        "slope": written(rows.cross_axis_tilt_deg),
    }
    for prefix, axis in AXES.items():
        found |= _actuator_texts(prefix, config.axis(axis).actuator)
    return found


def read(typed: Typed, config: TrackerConfig) -> TrackerConfig | None:
    """Return the typed configuration, None while anything in it is wrong."""
    mount = _mount(typed, config.mount)
    axes = {
        axis: _axis(typed, prefix, config.axis(axis)) if axis in config.mount.axes else config.axis(axis)
        for prefix, axis in AXES.items()
    }
    if typed.errors or mount is None:
        return None
    wanted = replace(config, mount=mount, azimuth=axes[Axis.AZIMUTH], elevation=axes[Axis.ELEVATION])
    return replace(wanted, park=_park(wanted))


def _park(config: TrackerConfig) -> Orientation:
    """Return the park position, as near to the old one as what the actuators leave of the axes."""
    if config.mount.kind is not MountKind.AZIMUTH_ELEVATION:
        return config.park
    reached = aim(config, Pointing(), config.park, config.azimuth.minimum_deg)
    if not reached.limited:
        return config.park
    return Orientation(wrap360(reached.azimuth_deg), reached.elevation_deg)


def _mount(typed: Typed, mount: MountConfig) -> MountConfig | None:
    wanted = mount
    if mount.kind is not MountKind.AZIMUTH_ELEVATION:
        azimuth_deg = typed.number("axis_azimuth", N_("Azimuth of the axis"), 0, 359.999, "°")
        wanted = replace(wanted, axis_azimuth_deg=azimuth_deg) if not typed.errors else wanted
    if mount.kind in (MountKind.EQUATORIAL, MountKind.TILTED_SINGLE_AXIS):
        tilt_deg = typed.number("axis_tilt", N_("Tilt of the axis"), 0, 90, "°")
        wanted = replace(wanted, axis_tilt_deg=tilt_deg) if not typed.errors else wanted
    if mount.kind is MountKind.VERTICAL_SINGLE_AXIS:
        tilt_deg = typed.number("panel_tilt", N_("Tilt of the panel"), 0, 90, "°")
        wanted = replace(wanted, panel_tilt_deg=tilt_deg) if not typed.errors else wanted
    rows = _rows(typed, mount)
    if typed.errors:
        return None
    if mount.kind is MountKind.AZIMUTH_ELEVATION:
        wanted = replace(wanted, least_incidence=bool(typed.text("least_incidence")))
    return replace(wanted, rows=rows)


def _rows(typed: Typed, mount: MountConfig) -> Rows | None:
    if mount.kind not in (MountKind.HORIZONTAL_SINGLE_AXIS, MountKind.TILTED_SINGLE_AXIS):
        return mount.rows
    if not typed.text("rows"):
        return None
    ratio = typed.number("ratio", N_("Ground coverage ratio"), 0.01, 1)
    slope_deg = typed.number("slope", N_("Slope across the rows"), -60, 60, "°")
    return None if typed.errors else Rows(ratio, slope_deg)


def _axis(typed: Typed, prefix: str, axis: AxisConfig) -> AxisConfig:
    """Return an axis with the actuator that was chosen, its limits and speed narrowed to what that allows."""
    name = f"{prefix}_actuator"
    chosen = typed.text(name) or NO_ACTUATOR
    if chosen == NO_ACTUATOR:
        return replace(axis, actuator=None)
    if chosen == OWN_POINTS:
        actuator = _own(typed, prefix)
        return axis if actuator is None else typed.read(name, lambda _: _narrowed(axis, actuator), axis)
    known = MECHANISMS.get(chosen)
    if known is None:
        typed.errors[name] = N_("Choose one of the actuators in the list.")
        return axis
    return typed.read(name, lambda _: _narrowed(axis, known()), axis)


def _narrowed(axis: AxisConfig, actuator: LinearActuator) -> AxisConfig:
    """Return the axis turned by an actuator, or raise `Unreadable` where they do not fit."""
    low_deg, high_deg = actuator.range_deg
    lower_deg = max(axis.minimum_deg, ceil(low_deg * 10.0) / 10.0)
    upper_deg = min(axis.maximum_deg, floor(high_deg * 10.0) / 10.0)
    if lower_deg >= upper_deg:
        raise Unreadable(
            say(
                "The stroke turns the axis from {low_deg} to {high_deg}°, which does not overlap the "
                "soft limits: check the axis angle of the points.",
                low_deg=with_format(low_deg, ".2f"),
                high_deg=with_format(high_deg, ".2f"),
            )
        )
    speed_dps = min(axis.speed_dps, floor(actuator.slowest_dps(lower_deg, upper_deg) * 1000.0) / 1000.0)
    try:
        return replace(
            axis,
            minimum_deg=lower_deg,
            maximum_deg=upper_deg,
            speed_dps=speed_dps,
            jog_slow_dps=min(axis.jog_slow_dps, speed_dps),
            jog_fast_dps=min(axis.jog_fast_dps, speed_dps),
            actuator=actuator,
        )
    except ValueError as error:
        raise Unreadable(told_by(error)) from error


def _own(typed: Typed, prefix: str) -> LinearActuator | None:
    """Return the actuator whose points were typed, None while something in them is wrong."""
    at = {
        name: typed.number(f"{prefix}_{name}", label, -FARTHEST_MM, FARTHEST_MM, "mm")
        for name, label in POINTS.items()
    }
    sizes = {
        name: typed.number(f"{prefix}_{name}", label, 0.1, FARTHEST_MM, "mm/s" if name == "speed" else "mm")
        for name, label in SIZES.items()
    }
    at_deg = typed.number(f"{prefix}_at", N_("Axis angle of the points"), -720, 720, "°")
    if typed.errors:
        return None
    try:
        return LinearActuator(
            base=Point(at["base_x"], at["base_y"], at["base_z"]),
            joint=Point(at["joint_x"], at["joint_y"], at["joint_z"]),
            at_deg=at_deg,
            retracted_mm=sizes["retracted"],
            travel_mm=sizes["travel"],
            speed_mm_s=sizes["speed"],
        )
    except ValueError as error:
        typed.errors[f"{prefix}_actuator"] = told_by(error)
        return None


def _actuator_texts(prefix: str, actuator: LinearActuator | None) -> dict[str, str]:
    if actuator is None:
        return {f"{prefix}_{name}": "" for name in ("at", *POINTS, *SIZES)} | {
            f"{prefix}_actuator": NO_ACTUATOR
        }
    base, joint = actuator.base, actuator.joint
    numbers = {
        "base_x": base.x_mm,
        "base_y": base.y_mm,
        "base_z": base.z_mm,
        "joint_x": joint.x_mm,
        "joint_y": joint.y_mm,
        "joint_z": joint.z_mm,
        "at": actuator.at_deg,
        "retracted": actuator.retracted_mm,
        "travel": actuator.travel_mm,
        "speed": actuator.speed_mm_s,
    }
    named = next((name for name, make in MECHANISMS.items() if make() == actuator), OWN_POINTS)
    return {f"{prefix}_{name}": written(value, FARTHEST_MM) for name, value in numbers.items()} | {
        f"{prefix}_actuator": named
    }
