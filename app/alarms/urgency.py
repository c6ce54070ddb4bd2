"""What is most urgent for a tracker and for the site: a list each, of which every page shows the head."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from operator import attrgetter

from app.alarms.alarm import Alarm, place_in
from app.alarms.catalogue import ANY_FAULT, CATALOGUE, Group, entry_of
from app.alarms.conditions import Condition, told_by_tracker
from app.base.message import N_, NOTHING, Message, Word, say
from app.tracker.protections.words import ServiceState
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Snapshot
from app.tracker.values.actors import CONTROLLER, LOCAL_USER
from app.tracker.values.alarm_words import CALLING, MOST_SHOWN, AlarmNow, AlarmState
from app.tracker.values.operator_message import INFORMATION, OperatorMessage, StateWord
from app.tracker.values.reason import Reason

MOST_URGENT = 3
"""The least urgent priority that the page of the whole site names a tracker for."""
TOLD_OTHERWISE = frozenset(
    (
        EventKind.ALARM_RAISED,
        EventKind.ALARM_RETURNED,
        EventKind.ALARM_ACKNOWLEDGED,
        EventKind.ALARM_SHELVED,
        EventKind.ALARM_UNSHELVED,
        EventKind.CONTROL_TAKEN,
        EventKind.CONTROL_REQUESTED,
        EventKind.CONTROL_DECLINED,
        EventKind.CONTROL_RELEASED,
        EventKind.MOTION_ANNOUNCED,
        EventKind.REMOTE_WRITTEN,
        EventKind.REMOTE_REFUSED,
        EventKind.RECORDING_DELETED,
        EventKind.SENSOR_INVALID,
        EventKind.SENSOR_VALID,
    )
)
"""Events that another place of the page tells, or that did nothing to the tracker."""
ACTIVE = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED)
IN_DANGER = (StateWord.NOT_STOWED, StateWord.FAULT, StateWord.NO_CONNECTION)
"""The states that are dangerous or not known, the most urgent first."""
FIRST_STATES = (*IN_DANGER, StateWord.STOWING)
"""The states in which trackers stand first, in this order; all others are equally urgent."""
_RANK = {word: FIRST_STATES.index(word) for word in FIRST_STATES}
_WORDS = {
    ActivityName.JOGGING: StateWord.JOGGING,
    ActivityName.MOVING: StateWord.MOVING,
    ActivityName.SETTING_HOME: StateWord.SETTING_HOME,
    ActivityName.HOMING: StateWord.HOMING,
    ActivityName.MEASURING: StateWord.DRIVE_TEST,
    ActivityName.SHOWING: StateWord.SHOW,
    ActivityName.STOPPING: StateWord.STOPPING,
    ActivityName.FAULTED: StateWord.FAULT,
    ActivityName.STOWING: StateWord.STOWING,
    ActivityName.STOWED: StateWord.STOWED,
}
_LOCAL = OperatorMessage(
    "local",
    INFORMATION,
    N_("Local: Heliopanel cannot move the tracker."),
    N_("The switch at the cabinet is on local."),
    N_("Turn it to remote to move the tracker from here. Nothing then continues automatically."),
)


def newest(last: Event | None, event: Event) -> Event | None:
    """Return the last thing that happened to a tracker, after one more event.

    What a stop ended is told at the same instant as the stop, which is what counts.
    """
    if event.kind in TOLD_OTHERWISE:
        return last
    of_stop = last is not None and last.kind is EventKind.STOPPED and last.at == event.at
    return last if of_stop and event.kind is not EventKind.STOPPED else event


def with_messages(tracker: Snapshot, alarms: Mapping[str, Alarm], last: Event | None) -> Snapshot:
    """Return a tracker with its state in a word and with what to know about it, as `messages_of` has it."""
    return replace(tracker, state=state_of(tracker), messages=messages_of(tracker, alarms, last))


def state_of(tracker: Snapshot) -> StateWord:
    """Return the state of a tracker: danger first, then what is not known, then what it does."""
    if tracker.not_stowed is not None:
        return StateWord.NOT_STOWED
    if tracker.fault is not None:
        return StateWord.FAULT
    if tracker.unreachable is not None:
        return StateWord.NO_CONNECTION
    if tracker.activity is ActivityName.HOLDING:
        return _holding(tracker)
    if tracker.activity is ActivityName.TRACKING:
        return _tracking(tracker)
    return _WORDS[tracker.activity]


def _tracking(tracker: Snapshot) -> StateWord:
    if tracker.approaching:
        return StateWord.MOVING_TO_THE_SUN
    return StateWord.WAITING if tracker.waiting else StateWord.TRACKING


def _holding(tracker: Snapshot) -> StateWord:
    """Return why a tracker at standstill stays there."""
    reasons = (
        (tracker.local, StateWord.LOCAL),
        (tracker.lock is not None, StateWord.INHIBITED),
        (tracker.service is not None, StateWord.SERVICE_MODE),
        (bool(tracker.waiting), StateWord.INTERRUPTED),
        (not tracker.homed, StateWord.NOT_HOMED),
    )
    return next((word for holds, word in reasons if holds), StateWord.AT_STANDSTILL)


def messages_of(
    tracker: Snapshot, alarms: Mapping[str, Alarm], last: Event | None
) -> tuple[OperatorMessage, ...]:
    """Return what to know about a tracker, the most urgent first, each code once.

    `alarms` are those of the tracker, and of the site that concern it, by `alarm_id`: one that was shelved,
    or is suppressed, is not told, unless it is the tracker's own state. A motion that is announced is first,
    since it begins within seconds; a stop by somebody comes before what is waited for, and before alarms that
    were there when it was pressed, but for those of priority 1.
    """
    urgent = sorted(_alarms(tracker, alarms), key=attrgetter("priority"))
    found: dict[str, OperatorMessage] = {}
    for one in (*_announced(tracker), *_with_stop(urgent, last), *_information(tracker, last)):
        found.setdefault(one.code, one)
    return tuple(found.values())


def _alarms(tracker: Snapshot, alarms: Mapping[str, Alarm]) -> Iterator[OperatorMessage]:
    """Yield what is present now, each once: an alarm that is raised, and a condition that may not be yet."""
    present: dict[str, Condition] = {}
    for condition in told_by_tracker(tracker):
        present.setdefault(condition.alarm_id, condition)
    for name, alarm in alarms.items():
        if alarm.active and not alarm.gone_since:
            present.setdefault(name, _condition(alarm))
    for name, condition in present.items():
        known = alarms.get(name)
        if known is None or not known.silent or _is_state(condition.code, tracker):
            yield _of_condition(condition, known)


def _is_state(code: str, tracker: Snapshot) -> bool:
    """Return whether an alarm is the tracker's own state, which is told whatever was done with the alarm."""
    fault = tracker.fault
    return code in ("not_stowed", "drive_lost") or (fault is not None and code in (fault.code, ANY_FAULT))


def _of_condition(condition: Condition, alarm: Alarm | None) -> OperatorMessage:
    entry = entry_of(condition.code)
    return OperatorMessage(
        condition.code,
        entry.priority,
        entry.title,
        condition.message,
        condition.hint or entry.do,
        since=alarm.raised_at if alarm is not None and alarm.active else None,
        alarm_id=condition.alarm_id,
        calls=alarm is not None and alarm.state in CALLING,
    )


def _condition(alarm: Alarm) -> Condition:
    return Condition(alarm.code, alarm.tracker_id, alarm.where, alarm.message, alarm.hint)


def _with_stop(urgent: list[OperatorMessage], last: Event | None) -> list[OperatorMessage]:
    """Return alarms with a stop by somebody before those that it found there, but for those of priority 1."""
    if last is None or not _is_by_somebody(last):
        return urgent
    ahead = [one for one in urgent if one.priority == 1 or one.since is None or one.since > last.at]
    return [*ahead, _happened(last), *(one for one in urgent if one not in ahead)]


def _announced(tracker: Snapshot) -> Iterator[OperatorMessage]:
    if tracker.warning is not None:
        yield _of(tracker.warning.reason)


def _information(tracker: Snapshot, last: Event | None) -> Iterator[OperatorMessage]:
    """Yield what is no alarm: who else has a say, what is waited for, what happened last, what to know."""
    if tracker.local:
        yield _LOCAL
    if tracker.service is not None:
        yield _service(tracker.service)
    request = tracker.control.request
    if request is not None:
        yield OperatorMessage(
            "control_requested",
            INFORMATION,
            say("{who} requests control: {why}", who=_name(request.by), why=request.reason),
        )
    happened = () if last is None else (_happened(last),)
    waits = tuple(_of(reason) for reason in tracker.waiting if reason.code not in CATALOGUE)
    is_stop = last is not None and last.kind is EventKind.STOPPED
    yield from (*happened, *waits) if is_stop else (*waits, *happened)
    yield from (_of(reason) for reason in tracker.notices if reason.code not in CATALOGUE)


def _of(reason: Reason) -> OperatorMessage:
    return OperatorMessage(reason.code, INFORMATION, reason.message, hint=reason.hint)


def _service(service: ServiceState) -> OperatorMessage:
    is_clear = service.clear_for_s > 0
    return OperatorMessage(
        "service",
        INFORMATION,
        say("In service mode by {who}: slow jog only.", who=_name(service.mode.name)),
        N_("The area is confirmed clear.") if is_clear else NOTHING,
        NOTHING if is_clear else N_("Nothing moves until the area is confirmed clear."),
    )


def _is_by_somebody(event: Event) -> bool:
    return event.kind is EventKind.STOPPED and event.actor != CONTROLLER


def _happened(event: Event) -> OperatorMessage:
    if _is_by_somebody(event):
        title, by = say("Stopped by {who}", who=_name(event.actor)), ""
    else:
        title, by = event.message, "" if event.actor == CONTROLLER else event.actor
    return OperatorMessage(event.kind.value, INFORMATION, title, since=event.at, by=by)


def _name(actor: str) -> str | Message | Word:
    """Return a user's name as it is; one who has none is told in the reader's language."""
    return Word(LOCAL_USER) if actor == LOCAL_USER else actor


def site_messages(trackers: Iterable[Snapshot], alarms: Iterable[AlarmNow]) -> tuple[OperatorMessage, ...]:
    """Return what is most urgent at a site, at most 50: one message a tracker, and the site's own alarms."""
    found = [_at(tracker) for tracker in by_urgency(filter(_is_urgent, trackers))]
    found += (_of_site(alarm) for alarm in alarms if alarm.tracker_id is None and alarm.state in ACTIVE)
    return tuple(sorted(found, key=attrgetter("priority"))[:MOST_SHOWN])


def by_urgency(trackers: Iterable[Snapshot]) -> list[Snapshot]:
    """Return trackers with the most urgent first: by the priority of their headline, then danger by its kind.

    Trackers that are equally urgent stay in their order.
    """
    return sorted(trackers, key=lambda one: (first_priority(one), _RANK.get(one.state, len(_RANK))))


def headline(tracker: Snapshot) -> OperatorMessage | None:
    """Return the most urgent message on a tracker's page: of its alarms, if any; else what it tells first."""
    return min(tracker.messages, key=attrgetter("priority"), default=None)


def own_headline(tracker: Snapshot) -> OperatorMessage | None:
    """Return the most urgent message of a tracker beside others: what concerns all of them is left out."""
    own = (one for one in tracker.messages if not one.alarm_id or place_in(one.alarm_id) is not None)
    return min(own, key=attrgetter("priority"), default=None)


def concerns_all(alarm: Alarm) -> bool:
    """Return whether an alarm of the site is told on the page of each tracker: its clock, or danger."""
    entry = alarm.entry
    return entry.priority == 1 or (entry.group is Group.CLOCK and entry.priority <= MOST_URGENT)


def first_priority(tracker: Snapshot) -> int:
    """Return the priority of the own headline of a tracker, `INFORMATION` without any alarm."""
    first = own_headline(tracker)
    return INFORMATION if first is None else first.priority


def _is_urgent(tracker: Snapshot) -> bool:
    return first_priority(tracker) <= MOST_URGENT or tracker.local


def _at(tracker: Snapshot) -> OperatorMessage:
    """Return what the site tells of a tracker: its headline, or that it is on local if nothing is urgent."""
    first = own_headline(tracker)
    told = first if first is not None and first.priority <= MOST_URGENT else _LOCAL
    return replace(told, tracker_id=tracker.tracker_id, where=tracker.name)


def _of_site(alarm: AlarmNow) -> OperatorMessage:
    return OperatorMessage(
        alarm.code,
        alarm.priority,
        alarm.title,
        alarm.message,
        alarm.do,
        since=alarm.since,
        alarm_id=alarm.alarm_id,
        calls=alarm.calls,
    )
