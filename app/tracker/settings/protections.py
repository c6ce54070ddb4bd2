"""What an engineer sets for the protections of one tracker."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from annotated_types import Ge, Le

from app.base.message import N_
from app.tracker.settings.declared import Setting, check


class StowName(StrEnum):
    """The places that a panel is stowed in; `park` is the park position."""

    WIND = "wind"
    SNOW = "snow"
    HAIL = "hail"
    CLEANING = "cleaning"
    MAINTENANCE = "maintenance"
    PARK = "park"


class Reaction(StrEnum):
    """What a reading that is missing, stale, frozen or impossible does."""

    IGNORE = "ignore"
    WARN = "warn"
    HOLD = "hold"
    STOW = "stow"


class Facing(StrEnum):
    """What the panel turns towards the wind when it is stowed."""

    ANYTHING = "anything"
    EDGE = "edge"
    BACK = "back"


GENTLE_REACTIONS = (
    (Reaction.IGNORE.value, N_("Ignore")),
    (Reaction.WARN.value, N_("Warn")),
    (Reaction.HOLD.value, N_("Hold position")),
)
REACTIONS = (*GENTLE_REACTIONS, (Reaction.STOW.value, N_("Stow panel")))
FACINGS = (
    (Facing.ANYTHING.value, N_("None: azimuth unchanged")),
    (Facing.EDGE.value, N_("Panel edge")),
    (Facing.BACK.value, N_("Panel back")),
)
Enabled = Annotated[bool, Setting(N_("Enable protection"))]
Required = Annotated[bool, Setting(N_("Sensor installed: report it even before its first reading"))]
Bad = Annotated[
    Reaction,
    Setting(
        N_("Sensor-fault reaction"),
        help=N_("Reaction to a silent, frozen, or implausible sensor. Usual: warn."),
        choices=REACTIONS,
    ),
]
GentleBad = Annotated[
    Reaction,
    Setting(
        N_("Sensor-fault reaction"),
        help=N_("Reaction to a silent, frozen, or implausible sensor. Usual: warn."),
        choices=GENTLE_REACTIONS,
    ),
]
BadAfter = Annotated[
    float,
    Ge(0),
    Le(3600),
    Setting(N_("Sensor-fault delay"), "s", help=N_("Reading missing, stale, frozen, or implausible.")),
]
TriggerDelay = Annotated[
    float, Ge(1), Le(86_400), Setting(N_("Trigger delay"), "s", help=N_("Without interruption."))
]


@dataclass(frozen=True, slots=True)
class WindProtection:
    """When the wind stows the panel, and when tracking goes on.

    A gust is the fastest wind of the last 3 s, the mean is over 10 minutes. Xia et al. stow at 17 m/s and go
    on after 10 minutes below it. `required` says that there is a sensor even if none was ever seen; what
    stands in for a bad one happens once it has been bad for `bad_after_s`.
    """

    enabled: Enabled = True
    gust_mps: Annotated[
        float, Ge(1), Le(60), Setting(N_("Gust threshold"), "m/s", help=N_("Highest wind speed over 3 s."))
    ] = 17.0
    mean_mps: Annotated[
        float, Ge(1), Le(60), Setting(N_("Mean-wind threshold"), "m/s", help=N_("Over 10 minutes."))
    ] = 17.0
    hysteresis_mps: Annotated[
        float,
        Ge(0),
        Le(20),
        Setting(N_("Release hysteresis"), "m/s", help=N_("Below both thresholds by this much.")),
    ] = 0.0
    resume_after_s: Annotated[
        float, Ge(10), Le(86_400), Setting(N_("Release delay"), "s", help=N_("Then tracking resumes."))
    ] = 600.0
    required: Required = False
    bad: Bad = Reaction.STOW
    bad_after_s: BadAfter = 60.0
    facing: Annotated[
        Facing,
        Setting(
            N_("Orientation to wind"),
            help=N_("Needs a wind vane; the azimuth is chosen when the stow begins. Usual: nothing."),
            choices=FACINGS,
        ),
    ] = Facing.ANYTHING

    def __post_init__(self) -> None:
        check(self)
        if self.hysteresis_mps >= min(self.gust_mps, self.mean_mps):
            raise ValueError(N_("The wind release hysteresis must be smaller than both wind thresholds."))


@dataclass(frozen=True, slots=True)
class SnowProtection:
    """When the panel is tipped to shed its snow: 4 kg for a minute, as Xia et al. have it."""

    enabled: Enabled = True
    load_kg: Annotated[
        float,
        Ge(0.1),
        Le(10_000),
        Setting(N_("Snow-load threshold"), "kg", help=N_("On one panel; 4 kg on 4 m² is 1 cm of snow.")),
    ] = 4.0
    hold_s: TriggerDelay = 60.0
    hysteresis_kg: Annotated[
        float, Ge(0), Le(1000), Setting(N_("Release hysteresis"), "kg", help=N_("Then tracking resumes."))
    ] = 0.0
    required: Required = False
    bad: Bad = Reaction.WARN
    bad_after_s: BadAfter = 60.0

    def __post_init__(self) -> None:
        check(self)
        if self.hysteresis_kg >= self.load_kg:
            raise ValueError(N_("The snow release hysteresis must be smaller than the snow-stow threshold."))


@dataclass(frozen=True, slots=True)
class LightProtection:
    """When tracking is not worth moving for: too little light for 10 minutes, as Xia et al. have it."""

    enabled: Enabled = True
    threshold_wm2: Annotated[
        float,
        Ge(0.1),
        Le(1000),
        Setting(N_("Low-light threshold"), "W/m²", help=N_("The panel holds its position.")),
    ] = 50.0
    hold_s: TriggerDelay = 600.0
    hysteresis_wm2: Annotated[
        float,
        Ge(0),
        Le(500),
        Setting(N_("Release hysteresis"), "W/m²", help=N_("Then tracking resumes immediately.")),
    ] = 10.0
    required: Required = False
    bad: GentleBad = Reaction.WARN
    bad_after_s: BadAfter = 60.0

    def __post_init__(self) -> None:
        check(self)
        if self.bad is Reaction.STOW:
            raise ValueError(
                N_("A faulty irradiance sensor cannot cause a stow: choose ignore, warn, or hold.")
            )


@dataclass(frozen=True, slots=True)
class StowPlace:
    """Where the panel is stowed, the direction of its normal: 90 degrees is a level panel, 0 an upright one.

    Without an azimuth the panel keeps the one it has.
    """

    elevation_deg: Annotated[float, Ge(0), Le(90), Setting(N_("Elevation"), "°")]
    azimuth_deg: (
        Annotated[
            float,
            Ge(0),
            Le(360),
            Setting(N_("Azimuth"), "°", help=N_("Usually empty: the panel keeps its azimuth.")),
        ]
        | None
    ) = None

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class Stows:
    """The stow positions by name; level against wind and upright against snow, as Xia et al. have it."""

    wind: Annotated[StowPlace, Setting(N_("Wind"))] = StowPlace(90.0)
    snow: Annotated[StowPlace, Setting(N_("Snow"))] = StowPlace(0.0)
    hail: Annotated[StowPlace, Setting(N_("Hail"))] = StowPlace(15.0)
    cleaning: Annotated[StowPlace, Setting(N_("Cleaning"))] = StowPlace(30.0)
    maintenance: Annotated[StowPlace, Setting(N_("Maintenance"))] = StowPlace(90.0)

    def place(self, name: StowName) -> StowPlace:
        """Return one position by its name; the park position is not among them."""
        return {
            StowName.WIND: self.wind,
            StowName.SNOW: self.snow,
            StowName.HAIL: self.hail,
            StowName.CLEANING: self.cleaning,
            StowName.MAINTENANCE: self.maintenance,
        }[name]


@dataclass(frozen=True, slots=True)
class ProtectionConfig:
    """The protections of one tracker, and the warning before a motion nobody at the machine asked for."""

    wind: Annotated[
        WindProtection,
        Setting(
            N_("Wind"),
            help=N_("Strong wind stows the panel immediately; tracking resumes after the release delay."),
        ),
    ] = WindProtection()
    snow: Annotated[
        SnowProtection,
        Setting(
            N_("Snow"),
            help=N_("A snow load moves the panel to its snow stow position, unless the wind is strong."),
        ),
    ] = SnowProtection()
    light: Annotated[
        LightProtection, Setting(N_("Low light"), help=N_("In low light, the panel holds its position."))
    ] = LightProtection()
    stows: Annotated[Stows, Setting(N_("Stow positions"))] = Stows()
    warning_s: Annotated[
        float,
        Ge(0),
        Le(60),
        Setting(N_("Warning time"), "s", help=N_("Countdown and horn; 0 switches the warning off.")),
    ] = 5.0

    def __post_init__(self) -> None:
        check(self)


PROTECTED = ProtectionConfig()
