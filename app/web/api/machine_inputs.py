"""What the API takes about the protections of the machine itself; what is left out stays."""

from pydantic import Field

from app.tracker.protections.machine_config import Recovery, Region
from app.web.api.base import Input


class RecoveryChange(Input):
    """How one class of fault is left."""

    kind: Recovery | None = Field(None, description="By a person, by itself, or in service mode only.")
    times_per_hour: int | None = Field(None, ge=1, le=60, description="With limited.")
    after_s: float | None = Field(None, ge=1, le=3600, description="Quiet time before it is left by itself.")


class RecoveriesChange(Input):
    """The recovery of every class of fault."""

    link: RecoveryChange | None = None
    drive: RecoveryChange | None = None
    following: RecoveryChange | None = None
    wiring: RecoveryChange | None = None
    switches: RecoveryChange | None = None
    travel: RecoveryChange | None = None
    supply: RecoveryChange | None = None


class MachineChange(Input):
    """Limits beyond which the machine is not what it should be, recovery, and forbidden regions."""

    creep_deg: float | None = Field(None, ge=0.1, le=45, description="Turning that is borne while halted.")
    overtravel_deg: float | None = Field(None, ge=0.1, le=45, description="Borne outside a soft limit.")
    switch_way_deg: float | None = Field(None, ge=0.5, le=90, description="Way off a switch that stays on.")
    overrun_factor: float | None = Field(None, ge=1, le=20, description="Of the way that a stop should take.")
    supply_low_v: float | None = Field(None, ge=0, le=1000)
    supply_high_v: float | None = Field(None, ge=0, le=1000, description="0: not watched.")
    clear_for_s: float | None = Field(None, ge=10, le=14_400, description="So long a clear area counts.")
    recovery: RecoveriesChange | None = None
    regions: tuple[Region, ...] | None = Field(
        None, max_length=20, description="Polygons of axis angles that the panel must not enter; as a whole."
    )
