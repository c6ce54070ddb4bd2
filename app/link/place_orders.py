"""Orders about the place where the site stands."""

from dataclasses import dataclass
from typing import ClassVar, Literal

from app.link.settings_orders import UndoSiteSettings
from app.sun.horizon import Horizon
from app.tracker.values.order_spec import setting


@dataclass(frozen=True, slots=True)
class SetHorizon:
    """What stands round the site and hides a low sun; without points the horizon is flat."""

    horizon: Horizon
    kind: Literal["set_horizon"] = "set_horizon"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)
