"""A form of a page as a browser sends it: every field with what stands in it, and what is typed over that."""

import re
from collections.abc import Mapping
from html import unescape

import httpx

from tests.web.tree import Tag, tree

Values = dict[str, list[str]]


def values_of(page: str, action: str) -> Values:
    """Return what a browser would send of the form of a page with this action."""
    values: Values = {}
    for form in tree(page).named("form"):
        if form.given.get("action") == action and form.given.get("method", "get") == "post":
            for one in form.all:
                if (value := value_of(one)) is not None:
                    values.setdefault(one.given["name"], []).append(value)
    return values


def value_of(one: Tag) -> str | None:
    """Return what is sent of an element; None if it is no field, or nothing is sent of it."""
    if one.name not in ("input", "select", "textarea") or not one.given.get("name"):
        return None
    if one.name == "textarea":
        return one.text
    if one.name == "select":
        options = one.named("option")
        chosen = [option for option in options if "selected" in option.given] or options[:1]
        return chosen[-1].given.get("value", "") if chosen else ""
    is_off = one.given.get("type") in ("checkbox", "radio") and "checked" not in one.given
    return None if is_off else one.given.get("value", "")


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


CONFIRMED = re.compile(r'name="confirmed"\s+value="([^"]+)"')


def confirmed_in(question: str) -> dict[str, str]:
    """Return what the button of a question sends, which stands for exactly what it asks."""
    found = CONFIRMED.search(question)
    assert found is not None, question
    return {"confirmed": unescape(found[1])}
