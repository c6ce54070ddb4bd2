"""Orders about the place where the site stands."""

from dataclasses import dataclass
from typing import Literal

from app.sun.horizon import Horizon


@dataclass(frozen=True, slots=True)
class SetHorizon:
    """What stands round the site and hides a low sun; without points the horizon is flat."""

    horizon: Horizon
    kind: Literal["set_horizon"] = "set_horizon"
