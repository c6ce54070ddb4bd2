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
    StepName.RUN: N_("Run"),
}
STATUS_TEXT = {
    StepStatus.DONE: Word("done"),
    StepStatus.TO_DO: Word("to do"),
    StepStatus.TO_BE_CONFIRMED: N_("to be confirmed"),
}
SITE_TABS = (
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
TRACKER_TABS = (
    (N_("Live"), ""),
    (N_("Commissioning"), "/commissioning"),
    (N_("Show"), "/show"),
    (N_("Sun path"), "/sun-path"),
    (N_("Trends"), "/trends"),
    (N_("Sun check"), "/sun-check"),
    (N_("Record"), "/record"),
    (N_("Settings"), "/settings"),
)


def site_frame(
    request: Request, title: str, *, back: Link | None = None, forward: Forward | None = None
) -> Frame:
    """Return the frame of a page about the whole site."""
    site, here = shown_site(request), request.url.path
    known = principal(request).is_known
    tabs = tuple(Link(label, href, _is_current(here, href)) for label, href in SITE_TABS if known)
    return _frame(request, title, site, tabs=tabs, back=back, forward=forward)


def tracker_frame(
    request: Request,
    tracker_id: str,
    title: str,
    *,
    steps: tuple[StepMark, ...] = (),
    back: Link | None = None,
    forward: Forward | None = None,
) -> Frame:
    """Return the frame of a page about one tracker; with steps there are no tabs."""
    site = shown_site(request)
    root, here = f"/trackers/{tracker_id}", request.url.path
    tabs = (
        ()
        if steps
        else tuple(Link(name, root + end, _is_under(here, root, end)) for name, end in TRACKER_TABS)
    )
    overview = Link(N_("Trackers"), "/")
    return _frame(
        request,
        title,
        site,
        tracker_id=tracker_id,
        tabs=tabs,
        steps=steps,
        back=back or overview,
        forward=forward or _elsewhere(root, here),
    )


def shown_site(request: Request) -> SiteSnapshot | None:
    """Return the machine now for those who may see it."""
    may = principal(request).may(Permission.READ)
    return panel(request).machine.latest() if may else None


def _elsewhere(root: str, here: str) -> Forward:
    return Forward(N_("Show"), f"{root}/show") if here == root else Forward(N_("Live"), root)


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
    tabs: tuple[Link, ...] = (),
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
        tabs=tabs,
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


def _is_current(here: str, href: str) -> bool:
    return here == href if href == "/" else here.startswith(href)


def _is_under(here: str, root: str, end: str) -> bool:
    """Return whether a page of a tracker belongs to a tab, as a running show does to Show."""
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
