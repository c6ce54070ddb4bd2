"""Photo-sensor pairs of a simulated tracker: what the sun, the panel's direction and clouds make them read.

Two sensors an axis look out from the panel, inclined by 45 degrees towards where the axis angle grows and
towards where it falls. Beam by Meinel and Meinel (Applied Solar Energy, 1976): 1353 W/m2 x 0.7^(m^0.678) with
m = 1 / sin(elevation); diffuse light, a tenth of the beam, reaches every sensor alike.
"""

from collections.abc import Callable
from math import cos, isclose, radians, sin, sqrt

from app.base.message import say
from app.simulation.faults import Fault, FaultKind
from app.sun.position import SunPosition
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import sky
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.values.motion import LightPair, LightReading

Vector = tuple[float, float, float]
SOLAR_CONSTANT_WM2 = 1353.0
DIFFUSE_SHARE = 0.1
LEAST_SINE = 0.01
NUDGE_DEG = 0.05
PLAIN = Pointing()
FULL_CLOUD = 1.0


class Sunlight:
    """The light on a simulated tracker's sensors; `sun` returns where the sun stands now, None if unknown.

    The panel really faces what its axes say, `pointing` known, less the misalignment that the configuration
    plays, so the misalignment is the correction to be found.
    """

    def __init__(
        self, config: TrackerConfig, sun: Callable[[], SunPosition | None], pointing: Pointing = PLAIN
    ) -> None:
        played = config.hybrid.simulated
        self._config = config
        self._pointing = pointing
        self._sun = sun
        self._misalignment_deg = {Axis.AZIMUTH: played.azimuth_deg, Axis.ELEVATION: played.elevation_deg}
        self._cloud = played.cloud
        self._stuck_wm2: dict[Axis, float] = {}
        self._sound = (dict(self._misalignment_deg), self._cloud)

    def inject(self, fault: Fault) -> None:
        """Play a misalignment (degrees), a cloud (share of the beam taken) or a stuck sensor (W/m2)."""
        hit = [axis for axis in Axis if fault.hits(axis)]
        match fault.kind:
            case FaultKind.MISALIGNED:
                self._misalignment_deg |= dict.fromkeys(hit, fault.amount)
            case FaultKind.CLOUD:
                self._cloud = min(FULL_CLOUD, max(0.0, fault.amount))
            case FaultKind.LIGHT_SENSOR_STUCK:
                self._stuck_wm2 |= dict.fromkeys(hit, fault.amount)
            case _:
                raise ValueError(say("{kind} is not a fault of the simulated sunlight.", kind=fault.kind))

    def clear(self) -> None:
        """Play again what the configuration says."""
        self._misalignment_deg, self._cloud = dict(self._sound[0]), self._sound[1]
        self._stuck_wm2 = {}

    def reading(self, axes: Orientation) -> LightReading:
        """Return what the sensors of a panel at these true axis angles read."""
        return LightReading(self._pair(Axis.AZIMUTH, axes), self._pair(Axis.ELEVATION, axes))

    def _pair(self, axis: Axis, axes: Orientation) -> LightPair:
        first_deg = axes.azimuth_deg - self._misalignment_deg[Axis.AZIMUTH]
        second_deg = axes.elevation_deg - self._misalignment_deg[Axis.ELEVATION]
        normal = self._normal(first_deg, second_deg)
        first_nudge_deg, second_nudge_deg = (NUDGE_DEG, 0.0) if axis is Axis.AZIMUTH else (0.0, NUDGE_DEG)
        behind = self._normal(first_deg - first_nudge_deg, second_deg - second_nudge_deg)
        ahead = self._normal(first_deg + first_nudge_deg, second_deg + second_nudge_deg)
        side = _side(behind, ahead)
        lower = self._irradiance_wm2(tuple(n - s for n, s in zip(normal, side, strict=True)))
        higher = self._irradiance_wm2(tuple(n + s for n, s in zip(normal, side, strict=True)))
        return LightPair(lower, self._stuck_wm2.get(axis, higher))

    def _irradiance_wm2(self, doubled: tuple[float, ...]) -> float:
        """Return what a sensor reads that looks along a vector of length sqrt(2)."""
        sun = self._sun()
        if sun is None or sun.elevation_deg <= 0.0:
            return 0.0
        beam_wm2 = _beam_wm2(sun.elevation_deg)
        towards = _unit(sun.azimuth_deg, sun.apparent_elevation_deg)
        cosine = sum(s * d for s, d in zip(towards, doubled, strict=True)) / sqrt(2.0)
        return beam_wm2 * (DIFFUSE_SHARE + (1.0 - self._cloud) * max(0.0, cosine))

    def _normal(self, first_deg: float, second_deg: float) -> Vector:
        faced = sky(self._config, self._pointing, first_deg, second_deg)
        return _unit(faced.azimuth_deg, faced.elevation_deg)


def _beam_wm2(elevation_deg: float) -> float:
    sine = max(LEAST_SINE, sin(radians(elevation_deg)))
    return float(SOLAR_CONSTANT_WM2 * 0.7 ** (sine**-0.678))


def _unit(azimuth_deg: float, elevation_deg: float) -> Vector:
    azimuth, elevation = radians(azimuth_deg), radians(elevation_deg)
    return cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)


def _side(behind: Vector, ahead: Vector) -> Vector:
    """Return the direction in which the normal turns, a unit vector; nothing where it does not turn."""
    north, east, up = (a - b for a, b in zip(ahead, behind, strict=True))
    length = sqrt(north * north + east * east + up * up)
    if isclose(length, 0.0, abs_tol=1e-7):
        return 0.0, 0.0, 0.0
    return north / length, east / length, up / length
