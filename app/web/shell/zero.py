"""Whether a home position is likely to be mistaken: the drive reads another angle than is claimed."""

from app.base.message import Message, say, with_format
from app.tracker.mounts.capabilities import axis_title
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import MountConfig, MountKind
from app.tracker.state.snapshot import Snapshot

JUMP_DEG = 2.0
"""By eye an axis is turned to its home position within a degree; a reading farther off is asked about."""
NOISE_DEG = 0.25
"""So far the reading of an axis at standstill may differ between a question and its answer."""


def zero_doubts(mount: MountConfig, tracker: Snapshot, axes: tuple[Axis, ...]) -> tuple[str, ...]:
    """Return what speaks against setting the home position here, as questions; it may be right."""
    states = {Axis.AZIMUTH: tracker.azimuth, Axis.ELEVATION: tracker.elevation}
    read = {axis: states[axis] for axis in mount.axes if axis in axes}
    return tuple(
        _question(mount, axis, state.position_deg)
        for axis, state in read.items()
        if state is not None and state.position_deg is not None and abs(state.position_deg) > JUMP_DEG
    )


def readings(mount: MountConfig, tracker: Snapshot) -> str:
    """Return where the axes stand, degrees, as the question about a home position names them."""
    states = {Axis.AZIMUTH: tracker.azimuth, Axis.ELEVATION: tracker.elevation}
    read = (states[axis] for axis in mount.axes)
    return " ".join(
        "-" if one is None or one.position_deg is None else f"{one.position_deg:.1f}" for one in read
    )


def is_answer(confirmed: str, now: str) -> bool:
    """Return whether somebody was asked about these readings; they may have changed by their noise."""
    asked, stands = confirmed.split(), now.split()
    try:
        pairs = [(float(one), float(other)) for one, other in zip(asked, stands, strict=True)]
    except ValueError:
        return False
    return bool(pairs) and all(abs(one - other) <= NOISE_DEG for one, other in pairs)


def _question(mount: MountConfig, axis: Axis, read_deg: float) -> Message:
    if mount.kind is not MountKind.AZIMUTH_ELEVATION:
        name = axis_title(mount, axis)
        return say(
            "The drive reads {read_deg}° for the {name} axis. Is the axis really at 0°?",
            read_deg=with_format(read_deg, ".1f"),
            name=name,
        )
    if axis is Axis.AZIMUTH:
        return say(
            "The measured azimuth is {read_deg}°. Does the panel really face north (0°)?",
            read_deg=with_format(read_deg, ".1f"),
        )
    return say(
        "The measured elevation is {read_deg}°. Is the panel really vertical (0°)?",
        read_deg=with_format(read_deg, ".1f"),
    )
