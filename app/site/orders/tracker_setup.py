"""Trackers come, change and go: always while they stand still, always stored first."""

from dataclasses import replace
from datetime import datetime

from app.base.message import N_, say
from app.link.messages import AddTracker, ConfigureTracker, RemoveTracker
from app.link.settings_orders import UndoSettings
from app.site.loop.loop import TrackerLoop
from app.site.orders import weather_setup
from app.site.orders.line_room import refuse_starved_drive
from app.site.recording.auditing import as_action
from app.site.state.model import SiteModel
from app.site.state.validation import check_config, with_clean_names
from app.tracker.access.location_change import against_another_aim, against_other_settings
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import Pointing, StepName, TrackerMemory, TrackerState
from app.tracker.motion.limit_change import Standing, review
from app.tracker.motion.target_change import aims_alike
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveKind, TrackerConfig
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

MOST_TRACKERS = 1000
NOTHING_TO_UNDO = Reason(
    "nothing_to_undo", N_("There is no stored settings change to undo."), N_("No action is needed.")
)


async def add(model: SiteModel, command: AddTracker, actor: str) -> tuple[Event, ...]:
    """Add a tracker."""
    weather_setup.refuse_real(model, command.config)
    config = with_clean_names(command.config)
    check_config(config)
    if config.tracker_id in model.loops:
        raise CommandRejected(
            Reason(
                "tracker_exists",
                say("Tracker {tracker_id} already exists.", tracker_id=config.tracker_id),
                N_("Choose another id."),
            )
        )
    if len(model.loops) >= MOST_TRACKERS:
        raise CommandRejected(
            Reason(
                "site_full", say("A site has at most {most_trackers} trackers.", most_trackers=MOST_TRACKERS)
            )
        )
    _refuse_shared_drive(model, config)
    model.check_drive(config)
    refuse_starved_drive(model, config)
    event = model.event(
        EventKind.TRACKER_ADDED, say("Tracker {name} was added.", name=config.name), actor, config.tracker_id
    )
    state = TrackerState(config, TrackerMemory())
    loop = model.add(state)
    try:
        await model.ledger.save_tracker(state, (event,))
    except CommandRejected:
        model.drop(config.tracker_id)
        await loop.close()
        raise
    loop.start()
    return (event,)


async def obey_configure(model: SiteModel, command: ConfigureTracker, actor: str) -> tuple[Event, ...]:
    """Replace a tracker's configuration as somebody ordered it."""
    weather_setup.refuse_real(model, command.config)
    return await configure(model, command.config, actor)


async def configure(model: SiteModel, config: TrackerConfig, actor: str) -> tuple[Event, ...]:
    """Replace a tracker's configuration while it stands still."""
    loop = model.tracker(config.tracker_id)
    config = with_clean_names(config)
    check_config(config)
    if aims_alike(loop.config, config):
        refuse_while_busy(loop)
    else:
        refuse_another_aim(loop)
    _refuse_unsafe_limits(loop, config)
    _refuse_shared_drive(model, config)
    old = loop.config
    rebuilt = _machine(old) != _machine(config)
    if rebuilt:
        model.check_drive(config)
    if config.drive != old.drive:
        refuse_starved_drive(model, config)
    event = model.event(
        EventKind.TRACKER_CHANGED,
        say("The configuration of {name} was changed.", name=config.name),
        actor,
        config.tracker_id,
        changed=_changed(old, config),
    )
    at = model.now()
    memory = _memory_for(loop.memory, old, config, at) if rebuilt else loop.memory
    await model.ledger.save_tracker(TrackerState(config, memory), (event,))
    if rebuilt:
        loop = await _rebuild(model, loop, config, at)
    else:
        loop.controller.configure(config, loop.drive.capabilities)
    if loop.memory != memory:
        await model.ledger.save_tracker(loop.state, ())
    if replace(old, drive=config.drive) != config:
        await _keep_former(model, {**model.state.former, config.tracker_id: old})
    return (event,)


async def undo(model: SiteModel, command: UndoSettings, actor: str) -> tuple[Event, ...]:
    """Set a tracker as it was before its last change, its drive aside; once more goes forth again."""
    config = model.tracker(command.tracker_id).config
    former = model.state.former.get(command.tracker_id)
    if former is None:
        raise CommandRejected(NOTHING_TO_UNDO)
    return await configure(model, replace(former, drive=config.drive), actor)


async def _keep_former(model: SiteModel, former: dict[str, TrackerConfig]) -> None:
    with as_action("keep_former"):
        await model.ledger.save_site(replace(model.state, former=former), ())
    model.state = replace(model.state, former=former)


async def _rebuild(model: SiteModel, loop: TrackerLoop, config: TrackerConfig, at: datetime) -> TrackerLoop:
    """Put a new loop with a new drive in the place of one that ends, with what that one knew last."""
    await loop.close()
    fresh = model.add(TrackerState(config, _memory_for(loop.memory, loop.config, config, at)))
    fresh.start()
    return fresh


def _memory_for(memory: TrackerMemory, old: TrackerConfig, new: TrackerConfig, at: datetime) -> TrackerMemory:
    """Return what stays true with other limits, another mount, actuator or drive.

    The last three have no trusted zero, and a move that nobody has judged yet was made with the former one.
    """
    memory = replace(memory, rejected=())
    if _zeroed(old) == _zeroed(new):
        return replace(memory, tracking_on=False)
    memory = replace(memory, proofs=replace(memory.proofs, move=None), home_lost_at=at)
    if old.mount.kind != new.mount.kind:
        return _remounted(memory)
    if old.drive == new.drive:
        return replace(memory, home=None, home_lost=N_("another actuator was configured."), tracking_on=False)
    return replace(
        memory,
        home=None,
        home_lost=N_("another drive was configured."),
        tracking_on=False,
        former_drive=old.drive,
    )


def _remounted(memory: TrackerMemory) -> TrackerMemory:
    """Return what stays true on another mount: neither zero nor mode nor corrections."""
    void = {StepName.HOMING, StepName.MODE}
    confirmations = {step: saved for step, saved in memory.confirmations.items() if step not in void}
    return replace(
        memory,
        home=None,
        home_lost=N_("another mount was configured."),
        tracking_on=False,
        mode=None,
        confirmations=confirmations,
        sightings=(),
        pointing=Pointing(),
    )


def _zeroed(config: TrackerConfig) -> tuple[object, ...]:
    """Return what a trusted zero, and the limits counted from it, were found with."""
    return config.mount.kind, config.drive, config.azimuth.actuator, config.elevation.actuator


def _machine(config: TrackerConfig) -> tuple[object, ...]:
    """Return what a drive and its zero depend on; a simulated one also has its light sensors made anew."""
    light = config.hybrid if config.drive.kind is DriveKind.SIMULATED else None
    return config.drive, config.azimuth, config.elevation, config.mount, light


def _changed(old: TrackerConfig, new: TrackerConfig) -> list[str]:
    return [name for name in TrackerConfig.__slots__ if getattr(old, name) != getattr(new, name)]


async def remove(model: SiteModel, command: RemoveTracker, actor: str) -> tuple[Event, ...]:
    """Remove a tracker that stands still."""
    tracker_id = command.tracker_id
    loop = model.tracker(tracker_id)
    refuse_while_busy(loop)
    event = model.event(
        EventKind.TRACKER_REMOVED,
        say("Tracker {name} was removed.", name=loop.config.name),
        actor,
        tracker_id,
    )
    memory = loop.memory
    await model.ledger.remove_tracker(tracker_id, (event,))
    model.drop(tracker_id)
    model.recorder.finish(tracker_id, model.now(), N_("tracker removed"))
    await loop.close()
    if loop.memory is not memory:
        await model.ledger.remove_tracker(tracker_id, ())
    if tracker_id in model.state.former:
        await _keep_former(
            model, {name: one for name, one in model.state.former.items() if name != tracker_id}
        )
    return (event,)


def _refuse_unsafe_limits(loop: TrackerLoop, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if the axes stand outside the new soft limits, unless the zero is another."""
    seen, same_zero = loop.feedback, _zeroed(loop.config) == _zeroed(config)
    if seen is None or not same_zero:
        return
    stands: dict[Axis, Standing] = {Axis.AZIMUTH: seen.azimuth, Axis.ELEVATION: seen.elevation}
    found = review(loop.config, config, stands, trusted=loop.memory.home is not None)
    if found.against:
        raise CommandRejected(*found.against)


def refuse_while_busy(loop: TrackerLoop) -> None:
    """Raise `CommandRejected` unless the tracker stands still and means to."""
    if reason := against_other_settings(loop.config.tracker_id, loop.doing, is_moving=loop.moving):
        raise CommandRejected(reason)


def refuse_another_aim(loop: TrackerLoop) -> None:
    """Raise `CommandRejected` unless the tracker stands still and tracking is switched off."""
    if reason := against_another_aim(loop.config.tracker_id, loop.doing, is_moving=loop.moving):
        raise CommandRejected(reason)


def _refuse_shared_drive(model: SiteModel, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if another tracker has this drive, or its line with other settings."""
    drive = config.drive
    if drive.kind is DriveKind.SIMULATED:
        return
    for loop in model.loops.values():
        other, name = loop.config.drive, loop.config.tracker_id
        if name == config.tracker_id or other.line != drive.line:
            continue
        shared = set(other.units) & set(drive.units)
        if shared:
            where = say("{line}, unit {shared}", line=drive.line, shared=min(shared))
            raise CommandRejected(
                Reason(
                    "drive_taken",
                    say("{name} already uses the drive at {where}.", name=name, where=where),
                    N_("Enter another address."),
                )
            )
        serial = drive.kind is DriveKind.MODBUS_RTU and other.serial != drive.serial
        if other.kind is not drive.kind or serial:
            raise CommandRejected(
                Reason(
                    "line_differs",
                    say("{name} uses line {line} with other settings.", name=name, line=drive.line),
                    N_("All drives on one line have the same baud rate, parity, and stop bits."),
                )
            )
