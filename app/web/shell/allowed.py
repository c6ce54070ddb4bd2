"""Shows what somebody may not do as it is: the same keys, disabled, with who may press them."""

import re
from collections.abc import Iterable
from html import escape

from app.access.principal import Principal
from app.access.roles import who_may
from app.base.message import say
from app.base.permission import Permission
from app.web.http.routes import Guarded, asked_of
from app.web.languages import said

FORM = re.compile(r'(<form\b[^>]*\bmethod="post"[^>]*>)(.*?)</form>', re.DOTALL)
ACTION = re.compile(r'\baction="([^"?]*)')
ID = re.compile(r'\bid="([^"]*)"')
KEY = re.compile(r'<button(?=[^>]*\bform="([^"]*)")')
SENDING_KEY = re.compile(r'<button(?=[^>]*\bhx-(?:post|put|delete)="([^"?]*))')


def shut(html: str, who: Principal, routes: Iterable[Guarded]) -> str:
    """Return a page with every form and key disabled that sends what the table does not allow.

    The page is this panel's own, whose values are escaped: no attribute holds an angle bracket.
    """
    if who.permissions >= set(Permission):
        return html
    shut_forms: set[str] = set()

    def form(match: re.Match[str]) -> str:
        action = ACTION.search(match[1])
        needed = _needed(action[1] if action else "", routes)
        if needed is None or who.may(needed):
            return match[0]
        shut_forms.update(ID.findall(match[1]))
        why = escape(said(say("Only for {needed}.", needed=who_may(needed))))
        fields = f'<fieldset class="denied" disabled>{match[2]}</fieldset>'
        return f'{match[1]}{fields}<p class="denied-why">{why}</p></form>'

    def key(match: re.Match[str]) -> str:
        return "<button disabled" if match[1] in shut_forms else match[0]

    def sending_key(match: re.Match[str]) -> str:
        needed = _needed(match[1], routes)
        return match[0] if needed is None or who.may(needed) else "<button disabled"

    return SENDING_KEY.sub(sending_key, KEY.sub(key, FORM.sub(form, html)))


def _needed(path: str, routes: Iterable[Guarded]) -> Permission | None:
    asked = asked_of(routes, {"type": "http", "method": "POST", "path": path})
    return asked.need.permission if asked.key else None
