"""An azimuth that comes round: which numbers another controller uses for it, and which turn a reading is of.

SunSpec model 601 counts azimuth from true north towards east and names no range. Controllers use 0 to 360 or
-180 to 180 degrees; some count turns.
"""

from app.drives.register import Register
from app.tracker.settings.axes import AxisConfig

TURN_DEG = 360.0
TOLERANCE_DEG = 1.0
"""An axis may stand so far beyond the ends of its range."""
FROM_NORTH, AROUND_NORTH = 0.0, -180.0


class AzimuthRange:
    """The numbers of one controller: those of the profile, else as its readings and refusals show them.

    The profile gives a range as `minimum` and `maximum` of the target; one wider than a turn counts turns.
    Until something shows that azimuth comes round, targets are written as the axis has them.
    """

    def __init__(self, axis: AxisConfig, target: Register) -> None:
        self._axis = axis
        self._low_deg: float | None = None
        self._is_configured = self._is_sure = target.minimum is not None and target.maximum is not None
        if target.minimum is not None and target.maximum is not None:
            self._low_deg = target.minimum if target.maximum - target.minimum <= TURN_DEG else None
        self._lowest_deg = self._highest_deg = 0.0

    def position_deg(self, read_deg: float, last_deg: float | None) -> float:
        """Return the turn of a reading that is nearest to the last position, as far as that is in the limits.

        The first reading is taken as it is where it lies in the limits, else nearest to their middle.
        """
        near_deg = read_deg
        if last_deg is not None:
            near_deg = self._axis.clamp(last_deg)
        elif self._axis.beyond_deg(read_deg) > TOLERANCE_DEG:
            near_deg = (self._axis.minimum_deg + self._axis.maximum_deg) / 2.0
        return read_deg + TURN_DEG * round((near_deg - read_deg) / TURN_DEG)

    def take_other(self, refused_deg: float) -> bool:
        """Take another range after a refusal of a target; return whether there is one to try."""
        if self._is_sure:
            return False
        if self._low_deg is None:
            self._low_deg = self._guess_deg(refused_deg)
            return self._low_deg is not None
        self._low_deg = None
        return True

    def count(self, azimuth_deg: float, step_deg: float) -> int:
        """Return the number that an azimuth is written as, in steps of so many degrees."""
        count = round(azimuth_deg / step_deg)
        if self._low_deg is None:
            return count
        low, turn = self._low_deg / step_deg, TURN_DEG / step_deg
        return round(low + (count - low) % turn)

    def learn(self, read_deg: float, position_deg: float) -> None:
        """Note a reading that is believed: one that is of another turn shows that azimuth comes round."""
        self._lowest_deg = min(self._lowest_deg, read_deg)
        self._highest_deg = max(self._highest_deg, read_deg)
        if self._is_configured:
            return
        if self._lowest_deg < -TOLERANCE_DEG and self._highest_deg > 180.0 + TOLERANCE_DEG:
            self._low_deg, self._is_sure = None, True
        elif abs(position_deg - read_deg) > TURN_DEG / 2.0 and not self._is_sure:
            guess_deg = self._guess_deg(0.0)
            self._low_deg, self._is_sure = FROM_NORTH if guess_deg is None else guess_deg, True

    def _guess_deg(self, azimuth_deg: float) -> float | None:
        """Return where the range begins, by what was read, else by a target that was refused."""
        if self._lowest_deg < -TOLERANCE_DEG:
            return AROUND_NORTH
        if self._highest_deg > 180.0 + TOLERANCE_DEG or azimuth_deg < 0.0:
            return FROM_NORTH
        return AROUND_NORTH if azimuth_deg > 180.0 else None
