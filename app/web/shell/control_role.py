"""How somebody who looks at a page stands to control: one word, which the page's keys follow."""

from enum import StrEnum

from app.tracker.commands.control import ControlState
from app.web.shell.who import Who


class Standing(StrEnum):
    """Free; mine, wished by another, forced from me; held, by one above; asked or waited for by me."""

    FREE = "free"
    MINE = "mine"
    WISHED = "wished"
    FORCED = "forced"
    HELD = "held"
    ABOVE = "above"
    ASKED = "asked"
    WAITING = "waiting"


def standing(control: ControlState, who: Who) -> Standing:
    """Return how somebody stands to control; static/js/control.js judges in the same way."""
    wish = control.request
    if control.holder is None:
        return Standing.FREE
    if (control.holder, control.via) == (who.actor, who.via):
        if wish is None:
            return Standing.MINE
        return Standing.WISHED if wish.can_be_refused else Standing.FORCED
    if wish is not None and (wish.by, wish.via) == (who.actor, who.via):
        return Standing.WAITING if wish.takes else Standing.ASKED
    return Standing.ABOVE if control.rank > who.weight else Standing.HELD
