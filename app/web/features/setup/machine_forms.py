"""What is typed on the page of the machine's protections, read into the domain's words and back."""

import re
from typing import Any

from pydantic import TypeAdapter

from app.base.message import N_, say
from app.tracker.protections.fault_classes import CLASSES
from app.tracker.settings.declared import declared, refusal
from app.tracker.settings.mechanics import (
    FARTHEST_DEG,
    MOST_CORNERS,
    MOST_REGIONS,
    FaultClass,
    MachineProtection,
    Region,
)
from app.tracker.values.minus import with_minus
from app.tracker.values.typed_numbers import written
from app.web.features.setup.protection_contexts import FaultRow
from app.web.features.setup.protection_forms import group_of
from app.web.shell import setting_forms
from app.web.shell.contexts import SettingRow
from app.web.shell.forms import Typed, Unreadable, clean_name
from app.web.shell.setting_forms import below, field_name, rows

REGIONS = "regions"
SPARE = 1
ANGLE = r"([+-]?\d+(?:[.,]\d+)?)"
CORNER = re.compile(rf"\s*{ANGLE}(?:\s*°)?(?:\s*/\s*|\s+){ANGLE}(?:\s*°)?\s*")
HOW = N_("Corners: type each as azimuth and elevation, such as 170 0; 190 0; 190 30; 170 30.")


def names() -> tuple[str, ...]:
    """Return every field of the form that a browser may send."""
    regions = [f"region{place}_{part}" for place in range(MOST_REGIONS) for part in ("name", "corners")]
    return (*(field_name(path) for path in declared(MachineProtection) if path != REGIONS), *regions)


def settings() -> tuple[SettingRow, ...]:
    """Return the limits with unit, range, usual value, and what they mean."""
    return rows(one for one in below(MachineProtection, "") if one.is_number)


def fault_rows() -> tuple[FaultRow, ...]:
    """Return every class of fault with the codes of the faults in it."""
    return tuple(
        FaultRow(
            group_of(MachineProtection, f"recovery.{fault}"),
            tuple(code for code, of in CLASSES.items() if of is fault),
        )
        for fault in FaultClass
    )


def places(typed: Typed) -> tuple[int, ...]:
    """Return the numbers of the regions to show: those that hold anything, and one more to add."""
    filled = [place for place in range(MOST_REGIONS) if _holds(typed, place)]
    return tuple(range(min(MOST_REGIONS, (filled[-1] + 1 if filled else 0) + SPARE)))


def texts(config: MachineProtection) -> dict[str, str]:
    """Return a tracker's machine protections as the form shows them."""
    found = setting_forms.texts(config)
    for place, region in enumerate(config.regions):
        corners = "; ".join(
            f"{written(one.azimuth_deg)} {written(one.elevation_deg)}" for one in region.corners
        )
        found |= {f"region{place}_name": region.name, f"region{place}_corners": corners}
    return found


def read(typed: Typed) -> MachineProtection | None:
    """Return the typed protections, None while anything in them is wrong."""
    wanted = setting_forms.typed_settings(typed, MachineProtection, regions=regions(typed))
    if (wrong := typed.errors.pop(REGIONS, None)) is not None:
        typed.errors["region0_name"] = wrong
    return wanted


def regions(typed: Typed) -> list[dict[str, Any]]:
    """Return the regions that can be read; what is wrong with the others stands in the form."""
    typed.text(REGIONS)  # says that their part of the page was there
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


def _name(text: str) -> str:
    name = clean_name(text)
    if not 1 <= len(name) <= 60:
        raise Unreadable(
            N_("Region: give it a name of 1 to 60 characters; to remove the region, clear both fields.")
        )
    return name


def _corners(text: str) -> list[dict[str, float]]:
    """Return the corners of a text such as `170 0; 190 0; 190 30`."""
    pairs = [part for part in re.split(r"[;\n]", with_minus(text)) if part.strip()]
    matches = [match for pair in pairs if (match := CORNER.fullmatch(pair))]
    if not 3 <= len(pairs) <= MOST_CORNERS or len(matches) < len(pairs):
        raise Unreadable(
            say("{how} A region has 3 to {most_corners} corners.", how=HOW, most_corners=MOST_CORNERS)
        )
    found = []
    for match in matches:
        azimuth, elevation = (float(one.replace(",", ".")) for one in match.groups())
        if abs(azimuth) > FARTHEST_DEG or abs(elevation) > FARTHEST_DEG:
            raise Unreadable(refusal(N_("Corners"), -FARTHEST_DEG, FARTHEST_DEG))
        found.append({"azimuth_deg": azimuth, "elevation_deg": elevation})
    return found
