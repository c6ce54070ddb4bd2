"""What an engineer sets for the protections of the machine itself, and what follows each class of fault."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated

from annotated_types import Ge, Le, MaxLen

from app.base.message import N_, say
from app.base.names import tidy
from app.tracker.settings.declared import Setting, check

MOST_REGIONS = 20
MOST_CORNERS = 20
FARTHEST_DEG = 720.0


class FaultClass(StrEnum):
    """The sorts of faults that have a recovery policy of their own."""

    LINK = "link"
    DRIVE = "drive"
    FOLLOWING = "following"
    WIRING = "wiring"
    SWITCHES = "switches"
    TRAVEL = "travel"
    SUPPLY = "supply"


class Recovery(StrEnum):
    """How a fault is left: by a person, by itself (some times an hour, or always), or by one in service."""

    NONE = "none"
    LIMITED = "limited"
    UNLIMITED = "unlimited"
    SERVICE = "service"


RECOVERIES = (
    (Recovery.NONE.value, N_("Manual reset")),
    (Recovery.LIMITED.value, N_("Automatic, limited retries")),
    (Recovery.UNLIMITED.value, N_("Automatic, unlimited retries")),
    (Recovery.SERVICE.value, N_("Manual, in service mode")),
)


@dataclass(frozen=True, slots=True)
class RecoveryPolicy:
    """What follows one class of fault; by itself it is left once it was quiet for `after_s`."""

    kind: Annotated[Recovery, Setting(N_("Reset"), help=N_("Usual: manual reset."), choices=RECOVERIES)] = (
        Recovery.NONE
    )
    times_per_hour: Annotated[
        int, Ge(1), Le(60), Setting(N_("Resets per hour"), help=N_("With limited retries."))
    ] = 3
    after_s: Annotated[float, Ge(1), Le(3600), Setting(N_("Quiet time"), "s")] = 60.0

    def __post_init__(self) -> None:
        check(self)


BY_A_PERSON = RecoveryPolicy()


@dataclass(frozen=True, slots=True)
class Recoveries:
    """The policy of every class of fault; unless an engineer decides otherwise a person leaves each."""

    link: Annotated[RecoveryPolicy, Setting(N_("Connection"), help=N_("The drive did not answer."))] = (
        BY_A_PERSON
    )
    drive: Annotated[
        RecoveryPolicy, Setting(N_("Drive"), help=N_("The drive reports a fault of its own."))
    ] = BY_A_PERSON
    following: Annotated[
        RecoveryPolicy,
        Setting(N_("Following"), help=N_("An axis does not follow, is frozen, or takes too long.")),
    ] = BY_A_PERSON
    wiring: Annotated[
        RecoveryPolicy,
        Setting(N_("Wiring"), help=N_("An axis turns the wrong way, or the wrong axis turns.")),
    ] = BY_A_PERSON
    switches: Annotated[
        RecoveryPolicy, Setting(N_("Limit switches"), help=N_("Both are on, or one stays on."))
    ] = BY_A_PERSON
    travel: Annotated[
        RecoveryPolicy, Setting(N_("Overtravel"), help=N_("An axis is beyond its soft limits."))
    ] = BY_A_PERSON
    supply: Annotated[
        RecoveryPolicy, Setting(N_("Supply"), help=N_("The supply voltage is out of range."))
    ] = BY_A_PERSON

    def of(self, fault: FaultClass) -> RecoveryPolicy:
        """Return the policy of one class."""
        policies = {
            FaultClass.LINK: self.link,
            FaultClass.DRIVE: self.drive,
            FaultClass.FOLLOWING: self.following,
            FaultClass.WIRING: self.wiring,
            FaultClass.SWITCHES: self.switches,
            FaultClass.TRAVEL: self.travel,
            FaultClass.SUPPLY: self.supply,
        }
        return policies[fault]


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner of a forbidden region, degrees of the first and the second axis."""

    azimuth_deg: Annotated[float, Ge(-FARTHEST_DEG), Le(FARTHEST_DEG), Setting(N_("Corners"), "°")]
    elevation_deg: Annotated[float, Ge(-FARTHEST_DEG), Le(FARTHEST_DEG), Setting(N_("Corners"), "°")]

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, slots=True)
class Region:
    """A polygon of axis angles that the panel must not enter, for what stands there, such as a wall."""

    name: str
    corners: tuple[Corner, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(tidy(self.name)) <= 60:
            raise ValueError(N_("A forbidden region has a name of 1 to 60 letters."))
        if not 3 <= len(self.corners) <= MOST_CORNERS:
            raise ValueError(
                say("A forbidden region has 3 to {most_corners} corners.", most_corners=MOST_CORNERS)
            )


@dataclass(frozen=True, slots=True)
class MachineProtection:
    """Limits beyond which the machine is not what it should be, in degrees of the axes.

    `creep_deg` is how far an axis may turn that was told to stand; `overtravel_deg` how far it may go on
    outside a soft limit; `switch_way_deg` how far it may leave a limit switch that stays on; a stop may be
    `overrun_factor` times as long as it was measured or computed, and 0.3 degrees. A supply outside
    `supply_low_v` to `supply_high_v` is a fault where the drive tells its voltage; 0 and 0: not watched.
    `clear_for_s` is how long the word that the area is clear counts in service mode.
    """

    creep_deg: Annotated[
        float,
        Ge(0.1),
        Le(45),
        Setting(
            N_("Standstill monitoring limit"), "°", help=N_("Uncommanded motion of an axis at standstill.")
        ),
    ] = 1.0
    overtravel_deg: Annotated[
        float,
        Ge(0.1),
        Le(45),
        Setting(
            N_("Overtravel limit"), "°", help=N_("Travel beyond a soft limit; above this, a fault is raised.")
        ),
    ] = 2.0
    switch_way_deg: Annotated[
        float,
        Ge(0.5),
        Le(90),
        Setting(
            N_("Limit-switch release distance"),
            "°",
            help=N_("Travel after which the switch must be off; otherwise it is stuck."),
        ),
    ] = 10.0
    overrun_factor: Annotated[
        float,
        Ge(1),
        Le(20),
        Setting(
            N_("Maximum stopping-distance ratio"),
            "×",
            help=N_("Relative to the measured or calculated distance; above this, an alarm is raised."),
        ),
    ] = 2.0
    supply_low_v: Annotated[
        float,
        Ge(0),
        Le(1000),
        Setting(N_("Minimum supply voltage"), "V", help=N_("For drives that report their voltage.")),
    ] = 0.0
    supply_high_v: Annotated[
        float, Ge(0), Le(1000), Setting(N_("Maximum supply voltage"), "V", help=N_("0 and 0: not monitored."))
    ] = 0.0
    clear_for_s: Annotated[
        float,
        Ge(10),
        Le(14_400),
        Setting(N_("Area-clear validity"), "s", help=N_("In service mode, from the confirmation.")),
    ] = 900.0
    recovery: Annotated[Recoveries, Setting(N_("Fault reset policy"))] = field(default_factory=Recoveries)
    regions: Annotated[
        tuple[Region, ...],
        MaxLen(MOST_REGIONS),
        Setting(
            N_("Forbidden regions"),
            help=N_(
                "Polygons of axis angles that the panel must not enter, such as a wall or a gate that "
                "opens. The whole path is checked, not only the target."
            ),
        ),
    ] = ()

    def __post_init__(self) -> None:
        check(self)
        if self.supply_low_v > self.supply_high_v:
            raise ValueError(N_("The lowest supply voltage must not exceed the highest."))
        if len(self.regions) > MOST_REGIONS:
            raise ValueError(
                say("There may be up to {most_regions} forbidden regions.", most_regions=MOST_REGIONS)
            )
        names = [region.name for region in self.regions]
        if len(set(names)) != len(names):
            raise ValueError(N_("Each forbidden region needs a unique name."))


GUARDED = MachineProtection()
