"""Where alarms are sent: addresses and priorities, and a test message."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, told_by
from app.base.permission import Permission
from app.link.alarm_orders import SetNotifications, TestNotification
from app.tracker.values.alarm_words import PRIORITIES
from app.tracker.values.notifications import Channel, Notifications
from app.web.features.alarms.alarm_contexts import NotificationsPage
from app.web.features.alarms.notifications_api import shown_to
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import CHECKED_ONLY
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep, PrincipalDep
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page

router = page_router(prefix="/site/notifications")
BACK = Link(N_("Site"), "/site")


@router.get("")
@needs(Permission.READ)
async def notifications(request: Request, machine: MachineDep, who: PrincipalDep) -> Response:
    """Show where alarms are sent."""
    now = shown_to(who, (await machine.detail()).site.notifications)
    return page(request, _page(request, now, now.webhook_url, ", ".join(now.mail_to)))


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    press: PressDep,
    webhook_url: Annotated[str, Form(max_length=600)] = "",
    mail_to: Annotated[str, Form(max_length=2000)] = "",
    webhook_priority: Annotated[tuple[int, ...], Form(), CHECKED_ONLY] = (),
    mail_priority: Annotated[tuple[int, ...], Form(), CHECKED_ONLY] = (),
) -> Response:
    """Keep them, or show the same form with what is wrong."""
    priorities = tuple(one for one in PRIORITIES if one in webhook_priority)
    by_mail = tuple(one for one in PRIORITIES if one in mail_priority)
    addresses = tuple(one for part in mail_to.split(",") if (one := part.strip()))
    try:
        wanted = Notifications(webhook_url.strip(), priorities, addresses, by_mail)
    except ValueError as error:
        typed = Notifications("", priorities, (), by_mail)
        context = _page(press.request, typed, webhook_url, mail_to, told_by(error))
        return page(press.request, context, block="form", status=422)
    await press.send(SetNotifications(wanted))
    return press.answer(N_("The notifications are saved."))


@router.post("/test")
@needs(Permission.CONFIGURE)
async def test(press: PressDep, channel: Annotated[Channel, Form()]) -> Response:
    """Send a test message."""
    await press.send(TestNotification(channel))
    return press.answer(N_("A test message is being sent; see the Site page for the result."))


def _page(
    request: Request, now: Notifications, webhook_url: str, mail_to: str, error: str = ""
) -> NotificationsPage:
    return NotificationsPage(
        frame=site_frame(request, N_("Notifications"), back=BACK),
        webhook_url=webhook_url,
        webhook_priorities=now.webhook_priorities,
        mail_to=mail_to,
        mail_priorities=now.mail_priorities,
        error=error,
    )
