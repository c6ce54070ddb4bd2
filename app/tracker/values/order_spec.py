"""What holds for an order wherever it comes from: said once, as `spec` of the order's dataclass."""

from dataclasses import dataclass
from enum import Enum, Flag, auto

from app.base.permission import Permission

AT_ONCE_S = 1.0
STORED_S = 5.0
LONG_S = 30.0
"""So long the link waits for an answer: of the controller, of the disk, and for much on a slow disk."""


class Interface(Flag):
    """Where an order can come from."""

    PAGE = auto()
    API = auto()
    MQTT = auto()
    SUNSPEC = auto()
    PEOPLE = PAGE | API
    EVERY = PEOPLE | MQTT | SUNSPEC


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """What interfaces tell of a value of an order, and what they take for it."""

    told: str = ""
    least: float | None = None
    most: float | None = None
    shortest: int | None = None
    longest: int | None = None
    choices: tuple[int, ...] = ()
    examples: tuple[str, ...] = ()


class Motion(Enum):
    """What an order does to motion.

    One that begins it is refused where its tracker was stopped since it was given. One that ends it is never
    late, never a repeat, has the lane for stops, and is never one too many: it ends one press, or it stops a
    tracker or all of them.
    """

    NONE = auto()
    BEGINS = auto()
    ENDS = auto()
    STOPS = auto()


@dataclass(frozen=True, slots=True, kw_only=True)
class OrderSpec:
    """What an order needs and what holds it back; what speaks against it now is in `interlocks.REQUIRED`.

    `needs` is the permission, `by` the interfaces, `within_s` how long the link waits. Each order is recorded
    unless it is not `audited`: a measurement, a reading, a sign of life. What is `held` is renewed many times
    a second: it is recorded when it changes something, and stored behind it. Without `control` it needs no
    control of its tracker: it stops, or is said by somebody who stands at the machine. Only with
    `in_safe_mode` it is carried out on a damaged database. One `at_a_time` waits for the change before it,
    `sealed` is refused while the settings are locked, and `undone_by` names the order that takes it back.
    """

    needs: Permission
    by: Interface = Interface.PEOPLE
    within_s: float = AT_ONCE_S
    motion: Motion = Motion.NONE
    audited: bool = True
    held: bool = False
    control: bool = True
    in_safe_mode: bool = False
    at_a_time: bool = False
    sealed: bool = False
    undone_by: type[object] | None = None

    @property
    def ends_motion(self) -> bool:
        """Return whether this ends a press or stops a tracker."""
        return self.motion in (Motion.ENDS, Motion.STOPS)


def setting(
    needs: Permission = Permission.CONFIGURE,
    *,
    by: Interface = Interface.PEOPLE,
    within_s: float = STORED_S,
    sealed: bool = False,
    undone_by: type[object] | None = None,
) -> OrderSpec:
    """Return the spec of an order that is stored before it is answered, one after the other."""
    return OrderSpec(
        needs=needs, by=by, within_s=within_s, at_a_time=True, sealed=sealed, undone_by=undone_by
    )
