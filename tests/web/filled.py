"""A form of a page as a browser sends it: every field with what stands in it, and what is typed over that."""

from collections.abc import Mapping
from html.parser import HTMLParser

import httpx

Values = dict[str, list[str]]


class _Form(HTMLParser):
    """Collects what a browser would send of the form with one action."""

    def __init__(self, action: str) -> None:
        super().__init__()
        self.action = action
        self.values: Values = {}
        self._inside = False
        self._field = ""
        self._is_first_option = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag == "form":
            self._inside = given.get("action") == self.action and given.get("method", "get") == "post"
        name = given.get("name", "")
        if not self._inside:
            return
        if tag == "option" and (self._is_first_option or "selected" in given):
            self.values[self._field][-1:] = [given.get("value", "")]
            self._is_first_option = False
        elif tag in ("select", "textarea"):
            self._field, self._is_first_option = name, tag == "select"
            self.values.setdefault(name, []).append("")
        elif (
            tag == "input" and name and ("checked" in given or given.get("type") not in ("checkbox", "radio"))
        ):
            self.values.setdefault(name, []).append(given.get("value", ""))

    def handle_data(self, data: str) -> None:
        if self._inside and self.get_starttag_text() and self.lasttag == "textarea":
            self.values[self._field][-1] += data

    def handle_endtag(self, tag: str) -> None:
        if tag == "form":
            self._inside = False


def values_of(page: str, action: str) -> Values:
    """Return what a browser would send of the form of a page with this action."""
    form = _Form(action)
    form.feed(page)
    return form.values


async def filled(
    client: httpx.AsyncClient,
    page: str,
    typed: Mapping[str, str | list[str]] | None = None,
    *,
    action: str = "",
) -> dict[str, list[str] | str]:
    """Return the fields of a form as its page shows them, with what is typed in their place."""
    shown = values_of((await client.get(page)).text, action or page)
    assert shown, f"{page} has no form {action or page}"
    return {**shown, **(typed or {})}
