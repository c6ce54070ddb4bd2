"""Where the real controller has a simulated drive stand through a day: for studies at its fidelity."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np

from app.base.message import N_
from app.energy.ideal import AxisPath
from app.show.axis_angles import axis_angles
from app.show.simulate import simulate
from app.studies.light import Days
from app.studies.request import StudyRequest, StudyStrategy
from app.sun.trigonometry import Array
from app.tracker.memory.memory import Pointing
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.settings.strategy import Continuous, Deadband, Interval, Stepped
from app.tracker.values.mode import Mode

FRAME = timedelta(minutes=1)


def rehearsed_axes(asked: StudyRequest, days: Days, mode: Mode, strategy: StudyStrategy) -> AxisPath:
    """Return the measured axis angles in the middle of every step of the one day of a study."""
    if asked.tracker is None:
        raise ValueError(N_("A study with the controller's control needs a tracker: choose one."))
    config = _with(asked, asked.tracker, strategy)
    at_s = days.at_unix_s[0]
    begin = datetime.fromtimestamp(at_s[0] - 30.0 * days.step_min, UTC)
    end = begin + timedelta(days=1)
    _, frames = simulate(
        config, Pointing(), days.location, asked.time_zone, mode, asked.held, begin, end, step=FRAME
    )
    seen_s = begin.timestamp() + frames.column("elapsed_s")
    stood_first_deg, stood_second_deg = axis_angles(config, Pointing(), frames)
    first_deg = _between(at_s, seen_s, np.unwrap(stood_first_deg, period=360.0))
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        first_deg = np.mod(first_deg, 360.0)
    else:
        first_deg = np.mod(first_deg + 180.0, 360.0) - 180.0
    second_deg = _between(at_s, seen_s, stood_second_deg)
    return AxisPath(first_deg[None, :], second_deg[None, :])


def _between(at_s: Array, seen_s: Array, values: Array) -> Array:
    return np.asarray(np.interp(at_s, seen_s, values), dtype=np.float64)


def _with(asked: StudyRequest, config: TrackerConfig, strategy: StudyStrategy) -> TrackerConfig:
    """Return the tracker's configuration with the strategy of a case."""
    match strategy:
        case StudyStrategy.CONTINUOUS:
            return replace(config, strategy=Continuous())
        case StudyStrategy.DEADBAND:
            return replace(config, strategy=Deadband(), deadband_deg=asked.deadband_deg)
        case StudyStrategy.INTERVAL:
            return replace(config, strategy=Interval(asked.interval_min))
        case StudyStrategy.PROGRAM:
            if asked.program is None:
                raise ValueError(N_("The strategy 'program' needs a program."))
            return replace(config, strategy=Stepped(asked.program))
