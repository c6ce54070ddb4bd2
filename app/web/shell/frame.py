"""Builds what all pages share from the request and the newest snapshot."""

from collections.abc import Iterable

from starlette.requests import Request

from app.access.principal import Principal, Via
from app.access.roles import Role
from app.base.message import N_, Word, join, say
from app.base.permission import Permission
from app.base.zones import shown_zone
from app.link.messages import TrackerDetail, UnknownTracker
from app.tracker.commissioning.steps import Step, StepStatus
from app.tracker.memory.memory import StepName
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.web.http.build_id import mark_of
from app.web.languages import said
from app.web.shell.asked import asked
from app.web.shell.contexts import Forward, Frame, Link, StepMark
from app.web.shell.deps import panel, principal
from app.web.shell.themes import choice_of, theme_of
from app.web.shell.who import Who

STEP_LABELS = {
    StepName.LOCATION: N_("Location"),
    StepName.CLOCK: N_("Clock"),
    StepName.HOMING: N_("Homing"),
    StepName.MODE: N_("Mode"),
    StepName.RUN: N_("Start"),
}
STATUS_TEXT = {
    StepStatus.DONE: Word("done"),
    StepStatus.TO_DO: Word("to do"),
    StepStatus.TO_BE_CONFIRMED: N_("to be confirmed"),
}
TRACKER_PAGES = (
    (N_("Live"), "", "tracker"),
    (N_("Commissioning"), "/commissioning", "steps"),
    (N_("Show"), "/show", "play-round"),
    (N_("Trends"), "/trends", "trend"),
    (N_("Settings"), "/settings", "sliders"),
    (N_("Sun path"), "/sun-path", ""),
    (N_("Sun check"), "/sun-check", ""),
    (N_("Drive tests"), "/drive-tests", ""),
    (N_("Protections"), "/protections", ""),
    (N_("Service"), "/service", ""),
    (N_("Record"), "/record", ""),
)
"""Pages of a tracker; those with a symbol stand in the rail, the others behind More."""
SITE_PAGES = (
    (N_("Trackers"), "/"),
    (N_("Alarms"), "/alarms"),
    (N_("Recordings"), "/recordings"),
    (N_("Simulate a day"), "/simulate"),
    (N_("Studies"), "/studies"),
    (N_("Accuracy"), "/accuracy"),
    (N_("Journal"), "/journal"),
    (N_("Site"), "/site"),
    (N_("Guide"), "/guide"),
)
"""Pages of the site: the first stands in the rail, the others behind More."""


def site_frame(
    request: Request, title: str, *, back: Link | None = None, forward: Forward | None = None
) -> Frame:
    """Return the frame of a page about the whole site."""
    return _frame(request, title, shown_site(request), back=back, forward=forward)


def tracker_frame(
    request: Request,
    tracker_id: str,
    title: str,
    *,
    steps: tuple[StepMark, ...] = (),
    back: Link | None = None,
    forward: Forward | None = None,
) -> Frame:
    """Return the frame of a page about one tracker."""
    site = shown_site(request)
    return _frame(request, title, site, tracker_id=tracker_id, steps=steps, back=back, forward=forward)


def shown_site(request: Request) -> SiteSnapshot | None:
    """Return the machine now for those who may see it."""
    may = principal(request).may(Permission.READ)
    return panel(request).machine.latest() if may else None


def _rail(request: Request, site: SiteSnapshot | None, tracker_id: str | None) -> tuple[Link, ...]:
    """Return the places of the rail: those of this tracker, else of the one that was looked at last."""
    here = request.url.path
    known = [one.tracker_id for one in site.trackers] if site else []
    last = request.cookies.get("tracker", "")
    shown = tracker_id or (last if last in known else next(iter(known), None))
    root = f"/trackers/{shown}"
    pages = [
        Link(name, root + end, _is_under(here, root, end), symbol)
        for name, end, symbol in TRACKER_PAGES
        if shown
    ]
    (overview, root), *others = SITE_PAGES
    places = [Link(name, href, here.startswith(href)) for name, href in others]
    return (Link(overview, root, here == root, "tiles"), *pages, *places)


def snapshot_of(site: SiteSnapshot | None, tracker_id: str | None) -> Snapshot | None:
    """Return one tracker's part of a snapshot; raise `UnknownTracker` if the machine has no such one."""
    if site is None or tracker_id is None:
        return None
    for one in site.trackers:
        if one.tracker_id == tracker_id:
            return one
    raise UnknownTracker(tracker_id)


def _frame(
    request: Request,
    title: str,
    site: SiteSnapshot | None,
    *,
    tracker_id: str | None = None,
    steps: tuple[StepMark, ...] = (),
    back: Link | None = None,
    forward: Forward | None = None,
) -> Frame:
    chosen = choice_of(request.cookies.get("theme"))
    current = next((mark for mark in steps if mark.current), None)
    return Frame(
        title=title,
        where=say(
            "Step {number} of {steps} · {label}", number=current.number, steps=len(steps), label=current.label
        )
        if current
        else title,
        path=request.url.path,
        theme=theme_of(chosen, site),
        theme_choice=chosen,
        zone=shown_zone(site.time_zone) if site else "UTC",
        site=site,
        tracker=snapshot_of(site, tracker_id) and (asked(request) or snapshot_of(site, tracker_id)),
        tracker_id=tracker_id,
        tabs=_rail(request, site, tracker_id) if principal(request).is_known else (),
        steps=steps,
        back=back,
        forward=forward,
        who=who_looks(request),
        is_bare=panel(request).settings.is_bare,
        mark=mark_of(panel(request).machine.latest()),
    )


def who_looks(request: Request) -> Who:
    """Return what a page says of who looks at it."""
    who, keeper = principal(request), panel(request).keeper
    session_id = request.scope.get("state", {}).get("session_id", "")
    session = keeper.book.sessions.get(who.credential)
    return Who(
        name=_name(who) if who.is_known else "",
        roles=join(" and ", map(Word, sorted(role.value for role in who.roles))),
        signed_in=who.via in (Via.SESSION, Via.KIOSK),
        is_kiosk=who.via is Via.KIOSK,
        this_computer=who.via is Via.LOOPBACK,
        may=frozenset(permission.value for permission in who.permissions),
        csrf=keeper.csrf(session_id) if session else "",
        stop_ticket=keeper.stop_ticket(who) if who.may(Permission.STOP) else "",
        stepped_until=session.stepped_until if session and Role.OPERATOR in who.roles else None,
        actor=who.actor,
        via=who.via.value,
        weight=who.rank,
    )


def _name(who: Principal) -> str:
    """Return a user's name; what sits at this computer has none, and is told in the language of the page."""
    return said(who.name) if who.via is Via.LOOPBACK else who.name


def _is_under(here: str, root: str, end: str) -> bool:
    """Return whether a page of a tracker belongs to a place of the rail, as a running show does to Show."""
    return here.startswith(root + end) if end else here == root


def step_marks(tracker: TrackerDetail, current: StepName | None) -> tuple[StepMark, ...]:
    """Return the step bar: back is always open, forward only as far as everything before is done."""
    root = f"/trackers/{tracker.state.config.tracker_id}/commissioning"
    names = [step.name for step in tracker.steps]
    reached = _first_open(tracker.steps)
    at = names.index(current) if current else -1
    return tuple(
        _mark(step, number, root if number <= max(reached, at) else None, current=step.name is current)
        for number, step in enumerate(tracker.steps)
    )


def _first_open(steps: Iterable[Step]) -> int:
    number = -1
    for number, step in enumerate(steps):
        if step.status is not StepStatus.DONE:
            return number
    return number


def _mark(step: Step, number: int, root: str | None, *, current: bool) -> StepMark:
    return StepMark(
        number=number + 1,
        name=step.name,
        label=STEP_LABELS[step.name],
        status=step.status.value,
        status_text=STATUS_TEXT[step.status],
        href=f"{root}/{step.name}" if root else None,
        current=current,
        reasons=step.reasons,
    )
