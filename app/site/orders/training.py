"""Playing faults on a simulated tracker and on made-up weather, for training; all of it is journaled."""

from collections.abc import Awaitable, Callable
from datetime import timedelta

from app.base.message import N_, say, told_by
from app.link.messages import EndInjectedFaults, InjectFault
from app.modbus.errors import DriveError, DriveRefused
from app.simulation.fault_injection import Trainer, trainer_of
from app.simulation.faults import Fault, FaultKind
from app.site.loop.loop import TrackerLoop
from app.site.orders.weather_setup import made_up_station, play
from app.site.state.model import SiteModel
from app.tracker.commands.commands import CommandRejected
from app.tracker.programs.fault_scenarios import Lesson, lesson
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

TRIED_FOR = timedelta(seconds=3)
BETWEEN = timedelta(milliseconds=250)
"""A connection on which silence is played is made anew again and again; in between it answers.

It takes as long as the drive lets it: what is set for the site is not kept waiting meanwhile.
"""


async def inject(model: SiteModel, command: InjectFault, actor: str) -> tuple[Event, ...]:
    """Play a fault, or raise `CommandRejected` on a tracker that is real."""
    return await _play(model, model.tracker(command.tracker_id), lesson(command.fault), actor)


async def end_faults(model: SiteModel, command: EndInjectedFaults, actor: str) -> tuple[Event, ...]:
    """End all faults that are played, or raise `CommandRejected` on a tracker that is real."""
    return await _clear(model, model.tracker(command.tracker_id), actor)


async def _play(model: SiteModel, loop: TrackerLoop, taught: Lesson, actor: str) -> tuple[Event, ...]:
    name = loop.config.name
    if taught.weather is not None:
        made_up_station(model)
    if taught.parts:
        trainer = _trainer(loop)
        faults = [Fault(FaultKind(one.kind), one.axis, one.amount) for one in taught.parts]
        await _reached(model, loop, lambda: trainer.play(faults))
    text = say("TRAINING: a fault was injected on {name}: {title}.", name=name, title=taught.title)
    event = model.event(EventKind.FAULT_INJECTED, text, actor, loop.config.tracker_id, fault=taught.fault)
    async with model.changing:
        if taught.weather is None:
            await model.ledger.append((event,))
        else:
            await play(model, taught.weather, event)
    loop.wake()
    return (event,)


async def _clear(model: SiteModel, loop: TrackerLoop, actor: str) -> tuple[Event, ...]:
    """End what is played on the tracker and with the weather; what the controller latched stays."""
    station = model.state.simulated_weather
    weather = station is not None and station.played is not None
    if not weather or trainer_of(loop.drive) is not None:
        trainer = _trainer(loop)
        await _reached(model, loop, trainer.clear)
    text = say("TRAINING: the injected faults of {name} have ended.", name=loop.config.name)
    event = model.event(EventKind.INJECTED_FAULTS_ENDED, text, actor, loop.config.tracker_id)
    async with model.changing:
        if weather:
            await play(model, None, event)
        else:
            await model.ledger.append((event,))
    loop.wake()
    return (event,)


def _trainer(loop: TrackerLoop) -> Trainer:
    """Return what plays faults on a tracker, or raise `CommandRejected` for one that may be real."""
    trainer = trainer_of(loop.drive)
    if trainer is None:
        raise CommandRejected(
            Reason(
                "not_simulated",
                say(
                    "{name} is not simulated; faults can be injected on a simulated tracker only.",
                    name=loop.config.name,
                ),
                N_("Add a simulated tracker for training, or connect one to heliopanel drive-sim."),
            )
        )
    return trainer


async def _reached(model: SiteModel, loop: TrackerLoop, work: Callable[[], Awaitable[None]]) -> None:
    """Do it, again where the connection was not there just then, or raise `CommandRejected`."""
    until = model.clock.now() + TRIED_FOR
    while True:
        try:
            await work()
        except DriveError as error:
            if model.clock.now() >= until or isinstance(error, DriveRefused):
                raise CommandRejected(_not_reached(loop, error)) from error
        else:
            return
        await model.clock.sleep_until(model.clock.now() + BETWEEN)


def _not_reached(loop: TrackerLoop, error: DriveError) -> Reason:
    return Reason(
        "training_not_reached",
        (
            say(
                "Faults of {name} are injected in heliopanel drive-sim, which refused this request: {error}",
                name=loop.config.name,
                error=told_by(error),
            )
        ),
        N_("Check that it runs with the simulated-plc profile; faults cannot be injected in a real PLC."),
    )
