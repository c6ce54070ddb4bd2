"""What everybody is told of control, word by word, and what of it is stored before it counts."""

import asyncio

import pytest

from app.link.messages import (
    AnswerControl,
    Order,
    ReleaseControl,
    RenewControl,
    RequestControl,
    UnknownTracker,
)
from app.site.state.authority import ASK_LASTS, COUNTDOWN, LEASE
from app.tracker.commands.commands import (
    JOG_LEASE,
    BeginServiceMode,
    CommandRejected,
    ConfirmAreaClear,
    EndServiceMode,
    Jog,
    Move,
    ReleaseInhibit,
    SelectMode,
    SetInhibit,
    Stop,
    Stow,
    Track,
)
from app.tracker.commands.control import ControlHeld, ControlLost
from app.tracker.memory.memory import TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from tests.site.plant import Begun, Plant, settle
from tests.site.test_control import AWAY, TAKE, Person

ABOUT_CONTROL = {
    EventKind.CONTROL_TAKEN,
    EventKind.CONTROL_REQUESTED,
    EventKind.CONTROL_DECLINED,
    EventKind.CONTROL_RELEASED,
}
Told = tuple[EventKind, str, str, dict[str, object]]


def told(plant: Plant, since: int = 0) -> list[Told]:
    """Return what was told of control, all of the one tracker there is."""
    events = [event for event in plant.events[since:] if event.kind in ABOUT_CONTROL]
    assert {event.tracker_id for event in events} <= {"T1"}
    return [(event.kind, event.message, event.actor, event.data) for event in events]


def taken(by: str, via: str = "session", *, actor: str = "", because: str = "") -> Told:
    message = f"{by} has control of Tracker 1 now.{because}"
    return EventKind.CONTROL_TAKEN, message, actor or by, {"holder": by, "via": via}


def asked(by: str, does: str, holder: str, *, takes: bool, because: str = "") -> Told:
    message = f"{by} {does} control of Tracker 1, which {holder} has.{because}"
    return EventKind.CONTROL_REQUESTED, message, by, {"takes": takes}


async def test_an_order_takes_control_and_silence_ends_it(ready: Plant) -> None:
    since = len(ready.events)
    await Person(ready, "ada").ask(AWAY)
    first = ready.tracker().control
    assert (first.holder, first.via, first.rank, first.is_program) == ("ada", "session", 1, False)
    assert first.since == ready.site.model.now()
    assert first.expires == ready.site.model.now() + LEASE
    assert first.epoch == ready.site.model.tracker("T1").memory.control_epoch
    await ready.forward(seconds=LEASE.total_seconds() - 0.5)
    assert ready.tracker().control.holder == "ada"
    await ready.forward(seconds=1)
    assert (ready.tracker().control.holder, ready.tracker().control.epoch) == (None, first.epoch + 1)
    text = "There was no signal from ada for 15 s: no user has control of Tracker 1 now."
    assert told(ready, since) == [
        taken("ada"),
        (EventKind.CONTROL_RELEASED, text, "controller", {"expired": True}),
    ]
    assert ready.site.model.tracker("T1").memory.control_epoch == first.epoch + 1


async def test_every_order_and_every_sign_of_a_page_renews_control(ready: Plant) -> None:
    ada = Person(ready, "ada")
    await ada.ask(AWAY)
    for order in (AWAY, RenewControl(("T1",)), RequestControl(("T1",)), AWAY):
        await ready.forward(seconds=LEASE.total_seconds() - 1)
        await ada.ask(order)
    assert ready.tracker().control.holder == "ada"
    await ready.forward(seconds=LEASE.total_seconds() - 1)
    await Person(ready, "bo").ask(RenewControl(("T1",)))
    await ready.forward(seconds=2)
    assert ready.tracker().control.holder is None


async def test_who_asks_is_told_with_the_reason_and_is_let_in_by_the_holder(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    since = len(ready.events)
    await bo.ask(RequestControl(("T1",), reason="  to clean it "))
    request = ready.tracker().control.request
    assert request is not None
    assert (request.by, request.via, request.takes, request.reason) == ("bo", "session", False, "to clean it")
    assert (request.until, request.can_be_refused) == (ready.site.model.now() + ASK_LASTS, True)
    await ada.ask(AnswerControl("T1", grants=True))
    assert told(ready, since) == [
        asked("bo", "requests", "ada", takes=False, because=" Reason: to clean it"),
        taken("bo", actor="ada"),
    ]
    with pytest.raises(CommandRejected, match="There is no request for control"):
        await bo.ask(AnswerControl("T1", grants=False))


async def test_a_wish_that_nobody_answers_lapses(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    epoch, since = ada.epoch, len(ready.events)
    await bo.ask(RequestControl(("T1",)))
    for _ in range(6):
        await ready.forward(seconds=9.5)
        await ada.ask(RenewControl(("T1",)))
    assert ready.tracker().control.request is not None
    await ready.forward(seconds=4)
    assert (ready.tracker().control.request, ready.tracker().control.holder) == (None, "ada")
    text = "The request for control of Tracker 1 was not answered."
    assert told(ready, since) == [
        asked("bo", "requests", "ada", takes=False),
        (EventKind.CONTROL_DECLINED, text, "controller", {}),
    ]
    assert ada.epoch == epoch, "nothing has passed"


async def test_a_countdown_is_told_and_passes_control_with_its_reason(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    since = len(ready.events)
    await bo.ask(TAKE)
    await bo.ask(TAKE)
    request = ready.tracker().control.request
    assert request is not None
    assert (request.takes, request.until) == (True, ready.site.model.now() + COUNTDOWN)
    await ready.forward(seconds=10.5)
    because = " Reason: rain is coming"
    assert told(ready, since) == [
        asked("bo", "takes", "ada", takes=True, because=because),
        taken("bo", because=because),
    ]


async def test_who_is_refused_and_who_lets_go_is_told(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",), reason=" early "))
    since = len(ready.events)
    await bo.ask(RequestControl(("T1",)))
    await ready.forward(seconds=10)
    await ada.ask(AnswerControl("T1", grants=False))
    assert ready.tracker().control.request is None
    await ready.forward(seconds=10)
    assert ready.tracker().control.holder == "ada", "the answer was a sign of life"
    await ada.ask(ReleaseControl("T1"))
    refused = "ada keeps control of Tracker 1; the request of bo was declined."
    assert told(ready, since)[-2:] == [
        (EventKind.CONTROL_DECLINED, refused, "ada", {}),
        (EventKind.CONTROL_RELEASED, "ada released control of Tracker 1.", "ada", {}),
    ]
    assert told(ready)[-4] == taken("ada", because=" Reason: early")


async def test_who_lets_go_lets_in_who_waits(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(AWAY)
    await bo.ask(RequestControl(("T1",)))
    await ada.ask(ReleaseControl("T1"))
    assert ready.tracker().control.holder == "bo"
    assert told(ready)[-1] == taken("bo", actor="ada")
    await ready.forward(seconds=1)
    assert not ready.site.model.tracker("T1").moving, "what ada set in motion was stopped"


@pytest.mark.parametrize("order", [AnswerControl("T1", grants=True), ReleaseControl("T1")])
async def test_only_who_has_control_gives_it_away(
    ready: Plant, order: AnswerControl | ReleaseControl
) -> None:
    bo = Person(ready, "bo")
    with pytest.raises(CommandRejected) as none:
        await bo.ask(order)
    assert [reason.code for reason in none.value.reasons] == ["no_control"]
    await Person(ready, "ada").ask(RequestControl(("T1",)))
    for wish in (None, TAKE):
        if wish is not None:
            await bo.ask(wish)
        with pytest.raises(ControlHeld, match="ada has control of Tracker 1"):
            await bo.ask(order)
    assert ready.tracker().control.holder == "ada", "the countdown is not cut short"


async def test_a_reason_has_200_letters_and_taking_over_needs_one(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    with pytest.raises(ValueError, match="at most 200 characters"):
        await bo.ask(RequestControl(("T1",), takes=True, reason="x" * 201))
    with pytest.raises(CommandRejected) as rejected:
        await bo.ask(RequestControl(("T1",), takes=True, reason="  "))
    assert [reason.code for reason in rejected.value.reasons] == ["no_reason"]
    await bo.ask(RequestControl(("T1",), takes=True, reason="x" * 200))
    assert ready.tracker().control.request is not None


@pytest.mark.parametrize(("via", "name"), [("sunspec", "SunSpec"), ("mqtt", "MQTT")])
async def test_a_door_of_programs_is_one_holder_and_waits_for_nobody(
    ready: Plant, via: str, name: str
) -> None:
    first, second = Person(ready, "10.0.0.7", via=via), Person(ready, "10.0.0.8", via=via)
    await first.ask(AWAY)
    control = ready.tracker().control
    assert (control.holder, control.via, control.is_program) == (name, via, True)
    assert told(ready)[-1] == taken(name, via, actor="10.0.0.7")
    await second.ask(AWAY)
    await second.ask(RequestControl(("T1",)))
    ada = Person(ready, "ada")
    await ada.ask(RequestControl(("T1",)))
    with pytest.raises(ControlHeld, match="ada has control"):
        await first.ask(RequestControl(("T1",)))
    assert ready.tracker().control.request is None, "it has no page to wait at"


async def test_what_somebody_at_the_machine_says_needs_no_control(ready: Plant) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    for command in (
        Stop(),
        SetInhibit("bo", "works"),
        ReleaseInhibit(),
        BeginServiceMode("bo"),
        ConfirmAreaClear(),
        EndServiceMode(),
    ):
        await bo.ask(command, epoch=0)
        assert ready.tracker().control.holder == "ada"


async def test_a_stow_goes_on_when_control_passes(ready: Plant) -> None:
    await Person(ready, "scada (token)", via="token").ask(Stow(StowName.WIND))
    await Person(ready, "bo").ask(RequestControl(("T1",)))
    assert ready.tracker().control.holder == "bo"
    assert ready.tracker().activity is ActivityName.STOWING
    await ready.until(lambda seen: seen.activity is ActivityName.STOWED)


@pytest.mark.parametrize("after_s", [1, 8], ids=["announced", "under way"])
async def test_tracking_that_has_yet_to_reach_the_sun_is_stopped_when_control_passes(
    ready: Plant, after_s: float
) -> None:
    program = Person(ready, "scada (token)", via="token")
    await program.ask(SelectMode(Mode.DUAL))
    await program.ask(Move(Orientation(90.0, 20.0)))
    await ready.forward(seconds=60)
    await program.ask(Track())
    await ready.forward(seconds=after_s)
    assert ready.tracker().activity is ActivityName.TRACKING
    await Person(ready, "bo").ask(RequestControl(("T1",)))
    assert ready.tracker().activity is not ActivityName.TRACKING
    await ready.forward(seconds=2)
    at = ready.tracker().measured
    await ready.forward(seconds=10)
    assert ready.tracker().measured == at, "no approach goes on that nobody ordered"


async def test_a_group_is_taken_as_a_whole_or_refused_with_everybody_who_has_a_part_of_it(
    begun: Begun,
) -> None:
    names = ("T1", "T2", "T3")
    configs = (TrackerConfig(name, name.replace("T", "Tracker ")) for name in names)
    plant = await begun(trackers=tuple(TrackerState(one, TrackerMemory()) for one in configs))
    ada, bo, cy = (Person(plant, name) for name in ("ada", "bo", "cy"))
    await bo.ask(RequestControl(("T2",)))
    await cy.ask(RequestControl(("T3",)))
    await ada.ask(RequestControl(("T1",)))
    with pytest.raises(ControlHeld) as refused:
        await ada.ask(RequestControl(("T1", "T2", "T3"), takes=True, reason="all"))
    assert [reason.message for reason in refused.value.reasons] == [
        "bo has control of Tracker 2.",
        "cy has control of Tracker 3.",
    ]
    assert [plant.tracker(name).control.holder for name in names] == ["ada", "bo", "cy"]
    with pytest.raises(UnknownTracker):
        await ada.ask(RequestControl(("T1", "T9")))
    await bo.ask(ReleaseControl("T2"))
    await cy.ask(ReleaseControl("T3"))
    await ada.ask(RequestControl(names))
    assert {plant.tracker(name).control.holder for name in names} == {"ada"}


async def test_an_order_of_an_older_epoch_does_not_take_control_that_is_free(ready: Plant) -> None:
    ada = Person(ready, "ada")
    await ada.ask(RequestControl(("T1",)))
    epoch = ada.epoch
    await ada.ask(ReleaseControl("T1"))
    with pytest.raises(ControlLost):
        await ada.ask(AWAY, epoch=epoch)
    with pytest.raises(ControlLost):
        await ada.ask(AWAY, epoch=ada.epoch + 1)
    assert ready.tracker().control.holder is None
    order = Order(Move(Orientation(170.0, 30.0)), "ada", "T1", via="session", rank=1)
    await ready.site.execute(order)
    assert ready.tracker().control.holder == "ada", "who does not say an epoch takes what is free"


async def test_a_jog_loses_of_its_lease_what_it_waited_while_control_passed(ready: Plant) -> None:
    ada, loop = Person(ready, "ada"), ready.site.model.tracker("T1")
    pressed_at = ready.clock.now()
    async with ready.site.model.control.lock("T1"):
        asking = asyncio.create_task(ada.ask(Jog("p", Axis.AZIMUTH, 1)))
        await settle()
        await ready.forward(seconds=0.1)
        assert not asking.done(), "while control passes an order waits"
        assert loop.activity is ActivityName.HOLDING
    await settle()
    assert loop.activity is ActivityName.JOGGING
    assert loop.deadline() == pressed_at + JOG_LEASE
    await asking


async def test_a_jog_that_waited_for_longer_than_its_lease_turns_nothing(ready: Plant) -> None:
    ada = Person(ready, "ada")
    async with ready.site.model.control.lock("T1"):
        asking = asyncio.create_task(ada.ask(Jog("p", Axis.AZIMUTH, 1)))
        await settle()
        await ready.forward(seconds=5)
    before = ready.tracker().measured
    await asking
    await ready.forward(seconds=1)
    assert ready.tracker().measured == before


@pytest.mark.parametrize(("name", "epochs", "kind"), [("bo", 0, ControlHeld), ("ada", -2, ControlLost)])
async def test_an_order_that_waited_is_judged_by_who_ordered_it_and_when(
    ready: Plant, name: str, epochs: int, kind: type[CommandRejected]
) -> None:
    await Person(ready, "ada").ask(RequestControl(("T1",)))
    who = Person(ready, name)
    async with ready.site.model.control.lock("T1"):
        asking = asyncio.create_task(who.ask(AWAY, epoch=who.epoch + epochs))
        await settle()
    with pytest.raises(kind):
        await asking
    assert ready.tracker().activity is ActivityName.HOLDING


@pytest.mark.parametrize(
    "said", [RequestControl(("T1",)), AnswerControl("T1", grants=True), ReleaseControl("T1")]
)
async def test_what_is_said_about_control_waits_until_it_has_passed(
    ready: Plant, said: RequestControl | AnswerControl | ReleaseControl
) -> None:
    ada, bo = Person(ready, "ada"), Person(ready, "bo")
    await ada.ask(RequestControl(("T1",)))
    await bo.ask(RequestControl(("T1",)))
    since = len(ready.events)
    async with ready.site.model.control.lock("T1"):
        asking = asyncio.create_task((bo if isinstance(said, RequestControl) else ada).ask(said))
        for _ in range(5):
            await settle()
        assert not asking.done()
        assert told(ready, since) == []
    await asking


async def test_what_was_ordered_at_the_moment_in_which_control_was_taken_goes(ready: Plant) -> None:
    ada = Person(ready, "ada")
    free = ada.epoch
    await ada.ask(AWAY)
    assert ada.epoch == free + 1
    await ada.ask(Stow(StowName.WIND), epoch=free)
    assert ready.tracker().activity is ActivityName.STOWING
    with pytest.raises(ControlLost):
        await ada.ask(AWAY, epoch=free - 1)


async def test_who_takes_over_is_who_stopped_the_motion(ready: Plant) -> None:
    await Person(ready, "scada (token)", via="token").ask(AWAY)
    await Person(ready, "bo").ask(RequestControl(("T1",)))
    assert ready.happened(EventKind.STOPPED)[-1].actor == "bo"
