"""Orders that change what is set; one at a time is carried out, and what the site has can be undone."""

from functools import partial

from app.link.alarm_orders import NotificationOrder
from app.link.messages import LockOrder
from app.link.record_orders import RecordOrder
from app.link.settings_orders import UndoSiteSettings
from app.site import notifying, records, settings_lock, site_orders, site_undo
from app.site.model import SiteModel
from app.tracker.snapshot import Event

Plain = LockOrder | RecordOrder | NotificationOrder | site_orders.SiteOrder
Change = Plain | UndoSiteSettings


async def carry_out(model: SiteModel, command: Change, actor: str) -> tuple[Event, ...]:
    """Carry out one order, stored before this returns, and return what happened."""
    settings_lock.refuse_locked(model, command)
    obey = partial(_obey, model, actor)
    if isinstance(command, UndoSiteSettings):
        return await site_undo.undo(model, obey)
    if isinstance(command, site_undo.SiteChange):
        return await site_undo.change(model, command, obey)
    return await obey(command)


async def _obey(model: SiteModel, actor: str, command: Plain) -> tuple[Event, ...]:
    if isinstance(command, LockOrder):
        return await settings_lock.carry_out(model, command, actor)
    if isinstance(command, RecordOrder):
        return await records.carry_out(model, command, actor)
    if isinstance(command, NotificationOrder):
        return await notifying.carry_out(model, command, actor)
    return await site_orders.carry_out(model, command, actor)
