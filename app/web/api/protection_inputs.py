"""What the API takes about protections; what is left out stays."""

from typing import Any

from pydantic import Field

from app.tracker.protections.words import Facing, Reaction, StowName
from app.web.api.base import Input


class WindChange(Input):
    """When the wind stows the panel, and when tracking goes on."""

    enabled: bool | None = None
    gust_mps: float | None = Field(None, ge=1, le=60, description="Fastest wind of 3 s, m/s.")
    mean_mps: float | None = Field(None, ge=1, le=60, description="Mean of 10 minutes, m/s.")
    hysteresis_mps: float | None = Field(None, ge=0, le=20)
    resume_after_s: float | None = Field(None, ge=10, le=86_400, description="Calm before tracking goes on.")
    required: bool | None = Field(None, description="A sensor is missed even if none was ever seen.")
    bad: Reaction | None = Field(None, description="What a bad reading does.")
    bad_after_s: float | None = Field(None, ge=0, le=3600)
    facing: Facing | None = Field(None, description="What is turned into the wind.")


class SnowChange(Input):
    """When the panel is tipped to shed its snow."""

    enabled: bool | None = None
    load_kg: float | None = Field(None, ge=0.1, le=10_000)
    hold_s: float | None = Field(None, ge=1, le=86_400)
    hysteresis_kg: float | None = Field(None, ge=0, le=1000)
    required: bool | None = None
    bad: Reaction | None = None
    bad_after_s: float | None = Field(None, ge=0, le=3600)


class LightChange(Input):
    """When there is too little light to move for."""

    enabled: bool | None = None
    threshold_wm2: float | None = Field(None, ge=0.1, le=1000)
    hold_s: float | None = Field(None, ge=1, le=86_400)
    hysteresis_wm2: float | None = Field(None, ge=0, le=500)
    required: bool | None = None
    bad: Reaction | None = Field(None, description="Anything but stow.")
    bad_after_s: float | None = Field(None, ge=0, le=3600)


class StowChange(Input):
    """A stow position, the direction of the panel's normal: elevation 90 is level, 0 upright."""

    elevation_deg: float | None = Field(None, ge=0, le=90)
    azimuth_deg: float | None = Field(None, ge=0, le=360, description="null: the panel keeps its azimuth.")


class StowsChange(Input):
    """The stow positions by name."""

    wind: StowChange | None = None
    snow: StowChange | None = None
    hail: StowChange | None = None
    cleaning: StowChange | None = None
    maintenance: StowChange | None = None


class ProtectionChange(Input):
    """Protections, stow positions, and the warning before a motion nobody at the machine asked for."""

    wind: WindChange | None = None
    snow: SnowChange | None = None
    light: LightChange | None = None
    stows: StowsChange | None = None
    warning_s: float | None = Field(None, ge=0, le=60)


def kept_azimuths(change: ProtectionChange | None) -> dict[str, Any]:
    """Return the stow positions whose azimuth was given as null on purpose: the panel keeps its own."""
    if change is None or change.stows is None:
        return {}
    given = {name: getattr(change.stows, name) for name in StowName if name is not StowName.PARK}
    kept = {
        str(name): {"azimuth_deg": None}
        for name, one in given.items()
        if one is not None and "azimuth_deg" in one.model_fields_set and one.azimuth_deg is None
    }
    return {"stows": kept} if kept else {}
