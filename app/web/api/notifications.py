"""Where alarms are sent."""

from pydantic import Field

from app.link.alarm_orders import SetNotifications, TestNotification
from app.tracker.notifications import Channel, Notifications
from app.web.api.base import REFUSED, Input, api_router
from app.web.api.orders import SenderDep
from app.web.deps import MachineDep
from app.web.errors import NotAcceptable

router = api_router(prefix="/site/notifications", tags=["alarms"])


class NotificationsIn(Input):
    """Addresses and the priorities that are sent there; an empty address: nowhere."""

    webhook_url: str = Field("", max_length=500, examples=["https://example.org/alarms"])
    webhook_priorities: tuple[int, ...] = Field((1, 2), max_length=4)
    mail_to: tuple[str, ...] = Field((), max_length=10, examples=[["night@example.org"]])
    mail_priorities: tuple[int, ...] = Field((1, 2), max_length=4)


@router.get("", summary="Where alarms are sent")
async def read_notifications(machine: MachineDep) -> Notifications:
    """Return addresses and priorities."""
    return (await machine.detail()).site.notifications


@router.put("", summary="Say where alarms are sent", responses=REFUSED)
async def write_notifications(wanted: NotificationsIn, sender: SenderDep) -> Notifications:
    """Replace addresses and priorities; alarms of before are not sent there."""
    try:
        notifications = Notifications(**wanted.model_dump())
    except ValueError as error:
        raise NotAcceptable(str(error)) from error
    await sender.send(SetNotifications(notifications))
    return notifications


@router.post("/{channel}/test", status_code=202, summary="Send a test message", responses=REFUSED)
async def test_notification(channel: Channel, sender: SenderDep) -> None:
    """Have a test message sent; `GET /site/integrations` says whether it arrived."""
    await sender.send(TestNotification(channel))
