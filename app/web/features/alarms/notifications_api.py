"""Where alarms are sent."""

from dataclasses import replace

from pydantic import Field

from app.access.principal import Principal
from app.base.addresses.masking import masked
from app.base.message import told_by
from app.base.permission import Permission
from app.link.alarm_orders import SetNotifications, TestNotification
from app.tracker.values.notifications import Channel, Notifications
from app.web.api.base import CHANGED, REFUSED, TAGGED, Input, api_router
from app.web.api.orders import SenderDep
from app.web.api.tags import of_site, tagged, unless_changed
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, PrincipalDep

router = api_router(prefix="/site/notifications", tags=["alarms"])
NOTIFICATIONS = of_site(lambda site: site.notifications)


class NotificationsIn(Input):
    """Addresses and the priorities that are sent there; an empty address: nowhere."""

    webhook_url: str = Field("", max_length=500, examples=["http://127.0.0.1:9/alarms"])
    webhook_priorities: tuple[int, ...] = Field((1, 2), max_length=4)
    mail_to: tuple[str, ...] = Field((), max_length=10, examples=[["night@localhost"]])
    mail_priorities: tuple[int, ...] = Field((1, 2), max_length=4)


@router.get("", summary="Where alarms are sent", responses=TAGGED, dependencies=[tagged(NOTIFICATIONS)])
@needs(Permission.READ)
async def read_notifications(machine: MachineDep, who: PrincipalDep) -> Notifications:
    """Return addresses and priorities; of the webhook who may not set it is told the host alone."""
    return shown_to(who, (await machine.detail()).site.notifications)


@router.put(
    "",
    summary="Say where alarms are sent",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(NOTIFICATIONS)],
)
@needs(Permission.CONFIGURE)
async def write_notifications(wanted: NotificationsIn, sender: SenderDep) -> Notifications:
    """Replace addresses and priorities; alarms of before are not sent there."""
    try:
        notifications = Notifications(**wanted.model_dump())
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    await sender.send(SetNotifications(notifications))
    return notifications


def shown_to(who: Principal, now: Notifications) -> Notifications:
    """Return where alarms are sent, with the webhook's address whole for who may set it."""
    sees = who.may_order(SetNotifications.spec) or who.may(Permission.ADMINISTER)
    return now if sees else replace(now, webhook_url=masked(now.webhook_url))


@router.post("/{channel}/test", status_code=202, summary="Send a test message", responses=REFUSED)
@needs(Permission.CONFIGURE)
async def test_notification(channel: Channel, sender: SenderDep) -> None:
    """Have a test message sent; `GET /site/integrations` says whether it arrived."""
    await sender.send(TestNotification(channel))
