"""What is typed on the page of the machine's protections, read into the domain's words and back."""

import re
from typing import Any

from pydantic import TypeAdapter, ValidationError

from app.adapter import adapter
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.protections.machine_config import (
    GUARDED,
    MOST_CORNERS,
    MOST_REGIONS,
    FaultClass,
    MachineProtection,
    Recovery,
    Region,
)
from app.web.protection_contexts import FaultRow, Setting
from app.web.ui.forms import Typed, Unreadable

NUMBERS: dict[str, tuple[str, str, float, float, str]] = {
    "overtravel_deg": (
        "Overtravel limit",
        "°",
        0.1,
        45,
        "Travel beyond a soft limit; above this, a fault is raised.",
    ),
    "creep_deg": (
        "Standstill monitoring limit",
        "°",
        0.1,
        45,
        "Uncommanded motion of an axis at standstill.",
    ),
    "overrun_factor": (
        "Maximum stopping-distance ratio",
        "×",
        1,
        20,
        "Relative to the measured or calculated distance; above this, an alarm is raised.",
    ),
    "switch_way_deg": (
        "Limit-switch release distance",
        "°",
        0.5,
        90,
        ("Travel after which the switch must be off; otherwise it is stuck."),
    ),
    "supply_low_v": ("Minimum supply voltage", "V", 0, 1000, "For drives that report their voltage."),
    "supply_high_v": ("Maximum supply voltage", "V", 0, 1000, "0 and 0: not monitored."),
    "clear_for_s": ("Area-clear validity", "s", 10, 14_400, "In service mode, from the confirmation."),
}
FAULTS: dict[FaultClass, tuple[str, str]] = {
    FaultClass.LINK: ("Connection", "The drive did not answer."),
    FaultClass.DRIVE: ("Drive", "The drive reports a fault of its own."),
    FaultClass.FOLLOWING: ("Following", "An axis does not follow, is frozen, or takes too long."),
    FaultClass.WIRING: ("Wiring", "An axis turns the wrong way, or the wrong axis turns."),
    FaultClass.SWITCHES: ("Limit switches", "Both are on, or one stays on."),
    FaultClass.TRAVEL: ("Overtravel", "An axis is beyond its soft limits."),
    FaultClass.SUPPLY: ("Supply", "The supply voltage is out of range."),
}
RECOVERIES = (
    (Recovery.NONE.value, "Manual reset"),
    (Recovery.LIMITED.value, "Automatic, limited retries"),
    (Recovery.UNLIMITED.value, "Automatic, unlimited retries"),
    (Recovery.SERVICE.value, "Manual, in service mode"),
)
PARTS = ("kind", "times_per_hour", "after_s")
SPARE = 1
FARTHEST_DEG = 720.0
CORNER = re.compile(r"\s*([+-−]?\d+(?:[.,]\d+)?)\s*°?\s*[/ ]\s*([+-−]?\d+(?:[.,]\d+)?)\s*°?\s*")
HOW = "Corners: type each as azimuth and elevation, such as 170 0; 190 0; 190 30; 170 30."


def names() -> tuple[str, ...]:
    """Return every field of the form that a browser may send."""
    faults = [f"{fault.value}_{part}" for fault in FaultClass for part in PARTS]
    regions = [f"region{place}_{part}" for place in range(MOST_REGIONS) for part in ("name", "corners")]
    return (*NUMBERS, *faults, *regions)


def settings() -> tuple[Setting, ...]:
    """Return the limits with unit, range, usual value and what they mean."""
    return tuple(
        Setting(name, label, unit, f"{text} {least:g} to {most:g}, usual {getattr(GUARDED, name):g}.")
        for name, (label, unit, least, most, text) in NUMBERS.items()
    )


def fault_rows() -> tuple[FaultRow, ...]:
    """Return every class of fault with the codes of the faults in it."""
    return tuple(
        FaultRow(fault.value, title, text, tuple(code for code, of in CLASSES.items() if of is fault))
        for fault, (title, text) in FAULTS.items()
    )


def places(typed: Typed) -> tuple[int, ...]:
    """Return the numbers of the regions to show: those that hold anything, and one more to add."""
    filled = [place for place in range(MOST_REGIONS) if _holds(typed, place)]
    return tuple(range(min(MOST_REGIONS, (filled[-1] + 1 if filled else 0) + SPARE)))


def texts(config: MachineProtection) -> dict[str, str]:
    """Return a tracker's machine protections as the form shows them."""
    found = {name: f"{getattr(config, name):g}" for name in NUMBERS}
    for fault in FaultClass:
        policy = config.recovery.of(fault)
        values = (policy.kind.value, str(policy.times_per_hour), f"{policy.after_s:g}")
        found |= {f"{fault.value}_{part}": text for part, text in zip(PARTS, values, strict=True)}
    for place, region in enumerate(config.regions):
        corners = "; ".join(f"{one.azimuth_deg:g} {one.elevation_deg:g}" for one in region.corners)
        found |= {f"region{place}_name": region.name, f"region{place}_corners": corners}
    return found


def read(typed: Typed) -> MachineProtection | None:
    """Return the typed protections, None while anything in them is wrong."""
    found: dict[str, Any] = {
        name: typed.number(name, label, least, most) for name, (label, _, least, most, _) in NUMBERS.items()
    }
    found["recovery"] = {fault.value: _policy(typed, fault) for fault in FaultClass}
    found["regions"] = regions(typed)
    if typed.errors:
        return None
    try:
        return adapter(MachineProtection).validate_python(found)
    except ValidationError as error:
        for one in error.errors():
            typed.errors[_field_of(one["loc"])] = one["msg"].removeprefix("Value error, ")
        return None


def regions(typed: Typed) -> list[dict[str, Any]]:
    """Return the regions that can be read; what is wrong with the others stands in the form."""
    found = []
    for place in range(MOST_REGIONS):
        if not _holds(typed, place):
            continue
        name = typed.read(f"region{place}_name", _name, "")
        nothing: list[dict[str, float]] = []
        corners = typed.read(f"region{place}_corners", _corners, nothing)
        if name and corners:
            found.append({"name": name, "corners": corners})
    return found


def drawable(typed: Typed) -> tuple[Region, ...]:
    """Return the regions that can be drawn already while others are still being typed."""
    adapter = TypeAdapter(Region)
    return tuple(adapter.validate_python(one) for one in regions(typed))


def _holds(typed: Typed, place: int) -> bool:
    return any(typed.texts.get(f"region{place}_{part}", "").strip() for part in ("name", "corners"))


def _policy(typed: Typed, fault: FaultClass) -> dict[str, Any]:
    title, _ = FAULTS[fault]
    return {
        "kind": typed.read(f"{fault.value}_kind", _recovery, Recovery.NONE),
        "times_per_hour": typed.whole(f"{fault.value}_times_per_hour", f"{title}: resets per hour", 1, 60),
        "after_s": typed.number(f"{fault.value}_after_s", f"{title}: quiet time", 1, 3600),
    }


def _recovery(text: str) -> Recovery:
    if text not in list(Recovery):
        raise Unreadable("Recovery: choose from the list how the fault is reset.")
    return Recovery(text)


def _name(text: str) -> str:
    if not 1 <= len(text) <= 60 or not text.isprintable():
        raise Unreadable(
            "Region: give it a name of 1 to 60 characters; to remove the region, clear both fields."
        )
    return text


def _corners(text: str) -> list[dict[str, float]]:
    """Return the corners of a text such as `170 0; 190 0; 190 30`."""
    pairs = [part for part in re.split(r"[;\n]", text) if part.strip()]
    matches = [match for pair in pairs if (match := CORNER.fullmatch(pair))]
    if not 3 <= len(pairs) <= MOST_CORNERS or len(matches) < len(pairs):
        raise Unreadable(f"{HOW} A region has 3 to {MOST_CORNERS} corners.")
    found = []
    for match in matches:
        azimuth, elevation = (float(one.replace("−", "-").replace(",", ".")) for one in match.groups())
        if abs(azimuth) > FARTHEST_DEG or abs(elevation) > FARTHEST_DEG:
            raise Unreadable("Corners: axis angles must be between -720 and 720 degrees.")
        found.append({"azimuth_deg": azimuth, "elevation_deg": elevation})
    return found


def _field_of(place: tuple[int | str, ...]) -> str:
    """Return the field that a rejected value was typed in; a rule about several shows at the first."""
    match place:
        case ("recovery", str(fault), *_):
            return f"{fault}_times_per_hour"
        case ("regions", int(number), *_):
            return f"region{number}_corners"
        case ():
            return "supply_low_v"
        case (first, *_):
            return str(first) if first in NUMBERS else "region0_name"
    return "supply_low_v"
