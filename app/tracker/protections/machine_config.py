"""What an engineer sets for the protections of the machine itself, and what follows each class of fault."""

from dataclasses import dataclass, field
from enum import StrEnum
from math import isfinite

MOST_REGIONS = 20
MOST_CORNERS = 20


def _check(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not (isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} must lie between {low:g} and {high:g} {unit}.".replace(" .", "."))


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


@dataclass(frozen=True, slots=True)
class RecoveryPolicy:
    """What follows one class of fault; by itself it is left once it was quiet for `after_s`."""

    kind: Recovery = Recovery.NONE
    times_per_hour: int = 3
    after_s: float = 60.0

    def __post_init__(self) -> None:
        if not 1 <= self.times_per_hour <= 60:
            raise ValueError("A fault may be reset automatically 1 to 60 times an hour.")
        _check("The quiet time before an automatic reset", self.after_s, 1.0, 3600.0, "s")


BY_A_PERSON = RecoveryPolicy()


@dataclass(frozen=True, slots=True)
class Recoveries:
    """The policy of every class of fault; unless an engineer decides otherwise a person leaves each."""

    link: RecoveryPolicy = BY_A_PERSON
    drive: RecoveryPolicy = BY_A_PERSON
    following: RecoveryPolicy = BY_A_PERSON
    wiring: RecoveryPolicy = BY_A_PERSON
    switches: RecoveryPolicy = BY_A_PERSON
    travel: RecoveryPolicy = BY_A_PERSON
    supply: RecoveryPolicy = BY_A_PERSON

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

    azimuth_deg: float
    elevation_deg: float

    def __post_init__(self) -> None:
        _check("The first axis of a corner", self.azimuth_deg, -720.0, 720.0, "degrees")
        _check("The second axis of a corner", self.elevation_deg, -720.0, 720.0, "degrees")


@dataclass(frozen=True, slots=True)
class Region:
    """A polygon of axis angles that the panel must not enter, for what stands there, such as a wall."""

    name: str
    corners: tuple[Corner, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.name.strip()) <= 60:
            raise ValueError("A forbidden region has a name of 1 to 60 letters.")
        if not 3 <= len(self.corners) <= MOST_CORNERS:
            raise ValueError(f"A forbidden region has 3 to {MOST_CORNERS} corners.")


@dataclass(frozen=True, slots=True)
class MachineProtection:
    """Limits beyond which the machine is not what it should be, in degrees of the axes.

    `creep_deg` is how far an axis may turn that was told to stand; `overtravel_deg` how far it may go on
    outside a soft limit; `switch_way_deg` how far it may leave a limit switch that stays on; a stop may be
    `overrun_factor` times as long as it was measured or computed, and 0.3 degrees. A supply outside
    `supply_low_v` to `supply_high_v` is a fault where the drive tells its voltage; 0 and 0: not watched.
    `clear_for_s` is how long the word that the area is clear counts in service mode.
    """

    creep_deg: float = 1.0
    overtravel_deg: float = 2.0
    switch_way_deg: float = 10.0
    overrun_factor: float = 2.0
    supply_low_v: float = 0.0
    supply_high_v: float = 0.0
    clear_for_s: float = 900.0
    recovery: Recoveries = field(default_factory=Recoveries)
    regions: tuple[Region, ...] = ()

    def __post_init__(self) -> None:
        _check("The standstill monitoring limit", self.creep_deg, 0.1, 45.0, "degrees")
        _check("The overtravel limit", self.overtravel_deg, 0.1, 45.0, "degrees")
        _check("The limit-switch release distance", self.switch_way_deg, 0.5, 90.0, "degrees")
        _check("The stopping-distance ratio", self.overrun_factor, 1.0, 20.0, "")
        _check("The lowest supply voltage", self.supply_low_v, 0.0, 1000.0, "V")
        _check("The highest supply voltage", self.supply_high_v, 0.0, 1000.0, "V")
        _check("The area-clear confirmation time", self.clear_for_s, 10.0, 14_400.0, "s")
        if self.supply_low_v > self.supply_high_v:
            raise ValueError("The lowest supply voltage must not exceed the highest.")
        if len(self.regions) > MOST_REGIONS:
            raise ValueError(f"There may be up to {MOST_REGIONS} forbidden regions.")
        names = [region.name for region in self.regions]
        if len(set(names)) != len(names):
            raise ValueError("Each forbidden region needs a unique name.")


GUARDED = MachineProtection()
