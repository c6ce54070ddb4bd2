"""Hybrid correction: photo-sensor pairs add a bounded correction to the computed axis angles.

The paper on a PLC of Bosch Rexroth with the PSA algorithm has u = computed + correction and gives neither
thresholds nor gains. Here the correction of an axis changes, while both sensors of its pair see enough light
and both axes stand where they were sent, at the rate gain (R1 - R2) / (R1 + R2): R1 looks towards larger axis
angles. It never exceeds its bound, in less light it decays or is held, and a pair that keeps pulling at the
bound, or differs by more than a panel near the sun can see, is not believed.
"""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from enum import StrEnum
from math import exp, inf, isfinite

from app.tracker.mounts.mount import AxisTarget, second_axis
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.strategy import HybridConfig, Stepped
from app.tracker.values.mode import Mode
from app.tracker.values.motion import Feedback, LightPair, LightReading

ON_PLACE_DEG = 0.1
"""So near to its computed and corrected place an axis has to be for its pair to tell a pointing error."""
NEAR_DEG = 2.0
"""And so near the other one, so that it does not turn the pair aside."""
LARGEST_RATIO = 0.5
LONGEST_STEP_S = 2.0
LONGEST_GAP_S = 5.0
"""After a longer time without tracking a correction has decayed as it does in the dark."""
PATIENCE = timedelta(seconds=60)
FOLLOWING = {
    Mode.FIXED: (False, False),
    Mode.AZIMUTH: (True, False),
    Mode.ELEVATION: (False, True),
    Mode.DUAL: (True, True),
}


class HybridPhase(StrEnum):
    """What the correction of an axis is doing."""

    UNUSED = "unused"
    CORRECTING = "correcting"
    WAITING = "waiting"
    DARK = "dark"
    DOUBTED = "doubted"


@dataclass(frozen=True, slots=True)
class AxisCorrection:
    """The correction of one axis, degrees; `at_bound_since` is when it last came to its bound."""

    degrees: float = 0.0
    phase: HybridPhase = HybridPhase.UNUSED
    at_bound_since: datetime | None = None


NO_CORRECTION = AxisCorrection()


@dataclass(frozen=True, slots=True)
class Corrected:
    """Computed axis angles, the correction of each axis at an instant, and their sum within the limits."""

    at: datetime
    computed: AxisTarget
    target: AxisTarget
    azimuth: AxisCorrection
    elevation: AxisCorrection


def correct(
    before: Corrected | None,
    config: TrackerConfig,
    mode: Mode,
    sun_target: AxisTarget,
    target: AxisTarget,
    feedback: Feedback,
    now: datetime,
) -> Corrected:
    """Return where the axes go: `target` plus the correction, within the soft limits.

    `sun_target` are the computed axis angles of the sun, which the sensors are compared with; `target` is
    where the strategy wants the axes. A step program is never corrected: its panel need not face the sun.
    While nothing was tracked, after a Stop or over night, `before` has decayed as in the dark.
    """
    elapsed_s = 0.0 if before is None else (now - before.at).total_seconds()
    if before is not None and elapsed_s > LONGEST_GAP_S:
        before, elapsed_s = _after_pause(before, config.hybrid, elapsed_s), 0.0
    off_deg = _off_place(before, config, sun_target, feedback)
    used = config.hybrid.enabled and not isinstance(config.strategy, Stepped)
    axes = []
    for axis, follows in zip(Axis, FOLLOWING[mode], strict=True):
        was = NO_CORRECTION if before is None else _of(before, axis)
        if not (used and follows):
            axes.append(NO_CORRECTION)
            continue
        pair, on_place = _pair(feedback.light, axis), _on_place(off_deg, sun_target, axis)
        axes.append(axis_correction(was, config.hybrid, pair, now, elapsed_s, on_place=on_place))
    azimuth, elevation = axes
    summed = target._replace(
        azimuth_deg=_sum_deg(config.azimuth, target.azimuth_deg, azimuth),
        elevation_deg=_sum_deg(second_axis(config), target.elevation_deg, elevation),
    )
    return Corrected(now, target, summed, azimuth, elevation)


def axis_correction(
    before: AxisCorrection,
    config: HybridConfig,
    pair: LightPair | None,
    now: datetime,
    elapsed_s: float,
    *,
    on_place: bool,
) -> AxisCorrection:
    """Return the correction of one axis after a time in which its pair read so."""
    ratio = _ratio(pair, config.threshold_wm2)
    if ratio is None:
        return AxisCorrection(_decayed(before.degrees, config, elapsed_s), HybridPhase.DARK)
    if before.phase is HybridPhase.DOUBTED or (on_place and abs(ratio) > LARGEST_RATIO):
        return AxisCorrection(_decayed(before.degrees, config, elapsed_s), HybridPhase.DOUBTED)
    if not on_place:
        return replace(before, phase=HybridPhase.WAITING)
    change_deg = config.gain_dps * ratio * min(max(elapsed_s, 0.0), LONGEST_STEP_S)
    degrees = min(config.bound_deg, max(-config.bound_deg, before.degrees + change_deg))
    if abs(degrees) < config.bound_deg:
        return AxisCorrection(degrees, HybridPhase.CORRECTING)
    since = before.at_bound_since or now
    phase = HybridPhase.DOUBTED if now - since >= PATIENCE else HybridPhase.CORRECTING
    return AxisCorrection(degrees, phase, since)


def _after_pause(before: Corrected, config: HybridConfig, elapsed_s: float) -> Corrected:
    """Return corrections that nobody looked after for a time; patience at the bound begins anew."""
    azimuth, elevation = (
        replace(axis, degrees=_decayed(axis.degrees, config, elapsed_s), at_bound_since=None)
        for axis in (before.azimuth, before.elevation)
    )
    return replace(before, azimuth=azimuth, elevation=elevation)


def _ratio(pair: LightPair | None, threshold_wm2: float) -> float | None:
    """Return (R1 - R2) / (R1 + R2); None unless both sensors see enough light."""
    if pair is None:
        return None
    higher, lower = pair.higher_wm2, pair.lower_wm2
    if not (isfinite(higher) and isfinite(lower) and min(higher, lower) >= threshold_wm2):
        return None
    return (higher - lower) / (higher + lower)


def _decayed(degrees: float, config: HybridConfig, elapsed_s: float) -> float:
    """Return a correction after a time without light: held where there is no decay."""
    degrees = min(config.bound_deg, max(-config.bound_deg, degrees))
    return degrees if config.decay_s == 0.0 else degrees * exp(-max(elapsed_s, 0.0) / config.decay_s)


def _on_place(off_deg: dict[Axis, float], sun_target: AxisTarget, axis: Axis) -> bool:
    """Return whether the pair of an axis sees the pointing error and little else.

    Another axis on its way turns the pair aside from the sun, which looks like an error of this one.
    """
    near = off_deg.get(axis, inf) <= ON_PLACE_DEG and max(off_deg.values()) <= NEAR_DEG
    return near and not sun_target.limited


def _off_place(
    before: Corrected | None, config: TrackerConfig, sun_target: AxisTarget, feedback: Feedback
) -> dict[Axis, float]:
    """Return how far each axis that the mount has stands from its computed and corrected place, degrees."""
    return {
        axis: abs(
            _computed_deg(sun_target, axis)
            + (0.0 if before is None else _of(before, axis).degrees)
            - (feedback.azimuth if axis is Axis.AZIMUTH else feedback.elevation).position_deg
        )
        for axis in config.mount.axes
    }


def _computed_deg(target: AxisTarget, axis: Axis) -> float:
    return target.azimuth_deg if axis is Axis.AZIMUTH else target.elevation_deg


def _sum_deg(axis: AxisConfig, computed_deg: float, correction: AxisCorrection) -> float:
    """Return computed angle plus correction, which never leads beyond a soft limit."""
    return axis.clamp(computed_deg + correction.degrees) if correction.degrees else computed_deg


def _pair(light: LightReading | None, axis: Axis) -> LightPair | None:
    if light is None:
        return None
    return light.azimuth if axis is Axis.AZIMUTH else light.elevation


def _of(corrected: Corrected, axis: Axis) -> AxisCorrection:
    return corrected.azimuth if axis is Axis.AZIMUTH else corrected.elevation
