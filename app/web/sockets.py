"""One WebSocket a page: state and events out; hold-to-run, stop and ping in."""

import asyncio
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from functools import partial
from secrets import token_hex
from typing import Annotated, Any, Literal, assert_never

from fastapi import APIRouter
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    TypeAdapter,
    ValidationError,
)
from starlette.websockets import WebSocket

from app.access.principal import NotAllowed, Principal, ProofNeeded, SignInNeeded
from app.base.instants import LAST_YEAR
from app.base.logs import get_logger
from app.base.message import N_, say, told_by
from app.base.permission import Permission
from app.link.lanes import Lanes
from app.link.messages import MachineUnreachable, RenewControl, ReportDeviceClock, StopAll, UnknownTracker
from app.tracker.access.location_change import MOST_APART
from app.tracker.commands.commands import CommandRejected, EndJog, Jog, Stop
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.values.reason import Reason
from app.web.api.numbers import no_boolean
from app.web.http.build_id import PageOutdated, refuse_outdated
from app.web.http.errors import machine_problem
from app.web.http.needs import needs
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import ENGLISH, code_of
from app.web.languages.live_texts import in_language
from app.web.live.hold_to_run import Heartbeat, LinkDelay, Presses, Verdict
from app.web.live.hub import TooManyViewers
from app.web.live.viewers import Message, TooSlow, Viewer, Wanted, pump
from app.web.shell.deps import Panel, order_of, principal

log = get_logger()
router = APIRouter()

MOST_IN_FLIGHT = 4
STAY_EVERY = timedelta(seconds=3)
LATEST_MS = datetime(LAST_YEAR + 1, 1, 1, tzinfo=UTC).timestamp() * 1000.0
"""What no clock of these times shows is not told."""
PROMPT = timedelta(seconds=5)
"""What a clock shows is not compared when it comes later than this."""
DEAD_PRESS = Reason(
    "press_dead", N_("This jog command has ended."), N_("Release the button and press it again.")
)
OLD_PAGE = Reason(
    "page_outdated",
    N_("This page is outdated."),
    N_("The page is being reloaded; then press the button again."),
)
SLOW_LINK = Reason(
    "link_too_slow",
    N_("The connection is too slow for hold-to-run."),
    N_("Move closer to the access point, or use incremental jog."),
)
UNMEASURED_LINK = Reason(
    "link_unmeasured",
    N_("The connection was not measured before this button was pressed."),
    N_("Release the button and press it again."),
)
STATUS_OF_CODE = {"press_dead": "dead", "busy": "busy"}
FORBIDDEN = (NotAllowed, ProofNeeded, SignInNeeded)
SIGNED_OUT = Message("signed_out", '{"type":"signed_out"}')


class _Incoming(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)


Name = Annotated[str, Field(min_length=1, max_length=64)]
Milliseconds = Annotated[float, Field(ge=0, le=1e14)]


class JogBeat(_Incoming):
    """The key is still held."""

    type: Literal["jog"]
    tracker_id: Name
    press_id: Name
    axis: Axis
    direction: Annotated[Literal[-1, 1], BeforeValidator(no_boolean)]
    speed: JogSpeed
    sequence: int = Field(ge=0, le=2**53)
    tc: Milliseconds
    rtt_ms: Milliseconds | None = None
    epoch: int | None = Field(None, ge=0, le=2**53)


class JogEnd(_Incoming):
    """The key was let go."""

    type: Literal["end_jog"]
    tracker_id: Name
    press_id: Name


class StopOne(_Incoming):
    """Stop one tracker now."""

    type: Literal["stop"]
    tracker_id: Name


class StopEverything(_Incoming):
    """Stop every tracker now."""

    type: Literal["stop_all"]


class Ping(_Incoming):
    """The page measures the connection, and tells whether somebody can see it, and what its clock shows.

    `at` is in milliseconds since 1970.
    """

    type: Literal["ping"]
    tc: Milliseconds
    visible: bool = False
    at: Milliseconds | None = None


Incoming = Annotated[JogBeat | JogEnd | StopOne | StopEverything | Ping, Discriminator("type")]
_incoming: TypeAdapter[Incoming] = TypeAdapter(Incoming)


class DeviceReports:
    """Tells the controller how far the clock of a page's device is off, while it is over a minute off."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel
        self._page = token_hex(8)
        self._told_at: datetime | None = None

    async def leave(self, who: Principal) -> None:
        """Tell that the page is gone, where the controller knows of its device's clock."""
        if self._told_at is not None:
            self._told_at = None
            await self._tell(self._panel.keeper.current(who), 0.0)

    async def _tell(self, who: Principal, ahead_s: float) -> None:
        with suppress(CommandRejected, MachineUnreachable, ValueError, *FORBIDDEN):
            await self._panel.machine.execute(order_of(who, ReportDeviceClock(self._page, ahead_s)))

    async def hear(self, shown_ms: float, who: Principal) -> None:
        """Tell what the device's clock shows where that has to be known, or is over."""
        site, now = self._panel.machine.latest(), self._panel.clock.now()
        who = self._panel.keeper.current(who)
        if site is None or not who.may(Permission.READ) or shown_ms > LATEST_MS:
            return
        ahead_s = site.at.timestamp() - shown_ms / 1000.0
        if abs(ahead_s) <= MOST_APART.total_seconds():
            due, told_at = self._told_at is not None, None
        else:
            due, told_at = self._told_at is None or now - self._told_at >= STAY_EVERY, now
        if due:
            self._told_at = told_at
            await self._tell(who, ahead_s)


class Session:
    """What one page asks for over its WebSocket."""

    def __init__(self, panel: Panel, viewer: Viewer, who: Principal, mark: str = "") -> None:
        self._machine = panel.machine
        self._clock = panel.clock
        self._hub = panel.hub
        self._keeper = panel.keeper
        self._viewer = viewer
        self._who = who
        self._mark = mark
        self._delay = LinkDelay()
        self._presses = Presses(self._delay, panel.hub.dead)
        self._in_flight = 0
        self._endings: Lanes[None] = Lanes(panel.clock)
        self._stray = JogEnd(type="end_jog", tracker_id="-", press_id="-")
        self._stayed_at = panel.clock.now() - STAY_EVERY
        self._device = DeviceReports(panel)

    def hear(self, text: str) -> None:
        """Act on one message; nothing here waits."""
        try:
            message = _incoming.validate_json(text)
        except ValidationError as error:
            fault = error.errors()[0]["msg"]
            self._tell(
                "problem",
                status=422,
                detail=say("The message was not understood: {fault}.", fault=fault),
                reasons=(),
            )
            return
        match message:
            case JogBeat():
                self._beat(message)
            case JogEnd():
                self._end_soon(message)
            case StopOne(tracker_id=tracker_id):
                self._stop_soon(Stop(), tracker_id)
            case StopEverything():
                self._stop_soon(StopAll())
            case Ping():
                self._pinged(message)
            case _:
                assert_never(message)

    def _pinged(self, ping: Ping) -> None:
        late = self._delay.beyond_best(ping.tc, self._clock.now())
        if ping.at is not None and late <= PROMPT:
            self._hub.spawn(self._device.hear(ping.at, self._who))
        if ping.visible:
            self._hub.spawn(self._stay())
        self._tell("pong", tc=ping.tc)

    def close(self) -> None:
        """The page is gone: end its presses at once, and forget its clock."""
        self._hub.spawn(self._device.leave(self._who))
        for tracker_id, press_id in self._presses.end_all(self._clock.now()):
            self._hub.spawn(self._end(tracker_id, press_id))

    def _tell(self, kind: str, **fields: Any) -> None:
        told = {"type": kind, **fields}
        self._viewer.tell(Message(kind, in_language(catalogue_of(self._viewer.wanted.language), told)))

    def _tell_problem(self, error: Exception) -> None:
        problem = machine_problem(error)
        told = {"status": problem.status, "detail": problem.detail, "reasons": problem.reasons}
        self._tell("problem", code=problem.code.value, **told)

    def _beat(self, beat: JogBeat) -> None:
        round_trip = None if beat.rtt_ms is None else timedelta(milliseconds=beat.rtt_ms)
        now = self._clock.now()
        heard = Heartbeat(beat.press_id, beat.tracker_id, beat.sequence, beat.tc, now, round_trip)
        verdict, lease = self._presses.judge(heard)
        match verdict:
            case Verdict.RENEW if self._in_flight < MOST_IN_FLIGHT:
                self._in_flight += 1
                self._hub.spawn(self._renew(beat, now + lease))
            case Verdict.RENEW | Verdict.IGNORE:
                pass
            case Verdict.DEAD:
                self._answer(beat.press_id, "dead", DEAD_PRESS)
            case Verdict.TOO_SLOW | Verdict.UNMEASURED:
                self._presses.end(beat.press_id)
                slow = verdict is Verdict.TOO_SLOW
                self._answer(beat.press_id, "refused", SLOW_LINK if slow else UNMEASURED_LINK)
            case _:
                assert_never(verdict)

    def _answer(self, press_id: str, status: str, *reasons: Reason) -> None:
        self._tell("jog", press_id=press_id, status=status, reasons=reasons)

    async def _renew(self, beat: JogBeat, until: datetime) -> None:
        """Renew a jog until an instant that was fixed when its heartbeat came, however busy the panel is."""
        lease = max(until - self._clock.now(), timedelta())
        jog = Jog(beat.press_id, beat.axis, beat.direction, beat.speed, beat.sequence, lease)
        try:
            refuse_outdated(self._mark, self._machine.latest())
            who = self._keeper.current(self._who)
            await self._machine.execute(order_of(who, jog, beat.tracker_id, epoch=beat.epoch))
            await self._keeper.used(who)
        except CommandRejected as error:
            self._refuse(beat.press_id, *error.reasons)
        except PageOutdated:
            self._refuse(beat.press_id, OLD_PAGE)
        except FORBIDDEN as error:
            self._refuse(beat.press_id, Reason("not_allowed", told_by(error)))
        except (MachineUnreachable, UnknownTracker, ValueError) as error:
            detail = machine_problem(error).detail
            self._refuse(beat.press_id, Reason("not_done", detail, N_("Wait, then press the button again.")))
        else:
            self._answer(beat.press_id, "ok")
        finally:
            self._in_flight -= 1

    def _refuse(self, press_id: str, *reasons: Reason) -> None:
        self._presses.end(press_id)
        statuses = [STATUS_OF_CODE[reason.code] for reason in reasons if reason.code in STATUS_OF_CODE]
        self._answer(press_id, statuses[0] if statuses else "refused", *reasons)

    async def _stay(self) -> None:
        """Renew control of what this page shows, where whoever looks at it has control."""
        site, who, now = self._machine.latest(), self._keeper.current(self._who), self._clock.now()
        if site is None or now - self._stayed_at < STAY_EVERY or not who.may(Permission.OPERATE):
            return
        mine = tuple(
            one.tracker_id
            for one in site.trackers
            if self._viewer.wanted.tracker_id in (None, one.tracker_id)
            and (one.control.holder, one.control.via) == (who.actor, who.via.value)
        )
        if mine:
            self._stayed_at = now
            with suppress(CommandRejected, MachineUnreachable, UnknownTracker, *FORBIDDEN):
                await self._machine.execute(order_of(who, RenewControl(mine)))

    def _end_soon(self, end: JogEnd) -> None:
        """End a press; of those that did not begin on this page the newest, for they move nothing here."""
        if self._presses.end(end.press_id):
            self._hub.spawn(self._end(end.tracker_id, end.press_id))
            return
        self._stray = end
        if not self._endings.waits(JogEnd):
            self._hub.spawn(self._endings.ask(JogEnd, self._end_stray))

    async def _end_stray(self) -> None:
        await self._end(self._stray.tracker_id, self._stray.press_id)

    async def _end(self, tracker_id: str, press_id: str) -> None:
        with suppress(CommandRejected, MachineUnreachable, UnknownTracker, ValueError, *FORBIDDEN):
            await self._machine.execute(order_of(self._who, EndJog(press_id), tracker_id))
        self._answer(press_id, "ended")

    def _stop_soon(self, stop: Stop | StopAll, tracker_id: str | None = None) -> None:
        """Stop at once, or with the next stop where one that this page asked for is under way."""
        site = self._machine.latest()
        if (
            site is not None
            and tracker_id is not None
            and all(one.tracker_id != tracker_id for one in site.trackers)
        ):
            self._tell_problem(UnknownTracker(tracker_id))
        elif not self._endings.waits(tracker_id):
            self._hub.spawn(self._endings.ask(tracker_id, partial(self._stop, stop, tracker_id)))

    async def _stop(self, stop: Stop | StopAll, tracker_id: str | None = None) -> None:
        try:
            await self._machine.execute(order_of(self._who, stop, tracker_id))
        except (CommandRejected, MachineUnreachable, UnknownTracker, ValueError, *FORBIDDEN) as error:
            log.error("stop failed", tracker_id=tracker_id, error=str(error))
            self._tell_problem(error)
        else:
            self._tell("stopped", tracker_id=tracker_id)


@router.websocket("/live")
@needs(Permission.STOP, lasts=True, ticketed=True)
async def live(
    websocket: WebSocket, tracker: str | None = None, page: str = "", language: str = ENGLISH.tag
) -> None:
    """Serve one page until it goes, or until it does not take what it is sent."""
    panel: Panel = websocket.app.state.panel
    who = principal(websocket)
    try:
        viewer = _viewer(panel, who, Wanted(tracker, language=code_of(language), trackers=who.trackers))
    except TooManyViewers:
        await websocket.close(1013, N_("too many viewers"))
        return
    session = Session(panel, viewer, who, page)
    try:
        await websocket.accept()
        await _serve(websocket, session, viewer, panel.hub.patience)
    finally:
        session.close()
        panel.hub.leave(viewer)


def _viewer(panel: Panel, who: Principal, wanted: Wanted) -> Viewer:
    """Return a viewer of the machine; for who may only stop, one that is shown nothing."""
    if who.may(Permission.READ, wanted.tracker_id):
        return panel.hub.join(wanted)
    blind = Viewer(wanted)
    blind.tell(SIGNED_OUT)
    return blind


async def _serve(websocket: WebSocket, session: Session, viewer: Viewer, patience: timedelta) -> None:
    async def send(message: Message) -> None:
        await websocket.send_text(message.text)

    sending = asyncio.create_task(pump(viewer, send, patience))
    hearing = asyncio.create_task(_listen(websocket, session))
    try:
        await asyncio.wait({sending, hearing}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        sending.cancel()
        hearing.cancel()
        ended = await asyncio.gather(sending, hearing, return_exceptions=True)
    if any(isinstance(end, TooSlow) for end in ended):
        log.warning("a reader of the live stream was too slow and is dropped")


async def _listen(websocket: WebSocket, session: Session) -> None:
    while (message := await websocket.receive())["type"] == "websocket.receive":
        session.hear(message.get("text") or "")
