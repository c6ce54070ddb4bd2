"""A refused order takes no form away: the answer stands beside it, or brings it again as it was typed.

errors.js puts an answer in the place of a part of the page only where the answer has the id of that part;
tests/browser/test_error_beside_form.py shows that it does so. Here every form is sent to a controller that
refuses every order.
"""

import re
from pathlib import Path

import httpx
import pytest

from app.tracker.values.reason import Reason
from tests.web.filled import value_of
from tests.web.forms import PageForm, every_form
from tests.web.office import Office
from tests.web.tree import Tag, tree

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

HTMX = {"HX-Request": "true"}
WHY = Reason("follows_the_sun", "T1 is tracking the sun.", "Stop T1 first.")
WHOLE = re.compile(r"<html\b|<!doctype\b", re.IGNORECASE)
OWN = frozenset({"back", "issued_at", "key", "epoch", "page"})
"""What every order carries, which nobody types."""
BUTTONS = frozenset({"submit", "button", "reset", "hidden", "password", "file"})


class Everything(dict[str, tuple[Reason, ...]]):
    """Refuses every order."""

    def get(self, _kind: str, _default: object = None) -> tuple[Reason, ...]:  # type: ignore[override]
        return (WHY,)


def nudged(text: str) -> str:
    """Return another number than what stands in a field, near it."""
    if re.fullmatch(r"[1-9]\d*", text):
        return str(int(text) + 1)
    return f"{text}1" if re.fullmatch(r"-?\d+\.\d+", text) else text


def fields_of(root: Tag) -> dict[str, list[str]]:
    """Return what a person sees in the fields of a form."""
    held: dict[str, list[str]] = {}
    for one in root.all:
        name = one.given.get("name", "")
        if name in OWN or one.given.get("type") in BUTTONS or (value := value_of(one)) is None:
            continue
        held.setdefault(name, []).append(value)
    return held


def sent_by(page: Tag, action: str) -> tuple[dict[str, list[str]], dict[str, list[str]]]:
    """Return what a browser sends of the form that is sent there, and what was typed of it."""
    for form in page.named("form"):
        if action not in (form.given.get("action"), form.given.get("hx-post")):
            continue
        for one in form.named("input"):
            if one.given.get("type", "text") == "text":
                one.given["value"] = nudged(one.given.get("value", ""))
        all_of_it: dict[str, list[str]] = {}
        for one in form.all:
            if (value := value_of(one)) is not None:
                all_of_it.setdefault(one.given["name"], []).append(value)
        return all_of_it, fields_of(form)
    return {}, {}


def lost(page: Tag, typed: dict[str, list[str]], answer: httpx.Response) -> list[str]:
    """Return what the answer to a refused order takes from the page, in words."""
    if answer.status_code < 400:
        return [f"is answered with {answer.status_code}"]
    if WHOLE.search(answer.text):
        return []
    ids = {one.given["id"] for one in page.all if one.given.get("id")}
    told = tree(answer.text)
    renewed = next((one for one in told.below if one.given.get("id") in ids), None)
    if renewed is None:
        return [f"{one} comes as a refusal" for one in told.all if one.name in ("input", "select")]
    form = next(iter([renewed, *renewed.all]), renewed)
    held = fields_of(form)
    return [
        f"{name} was {values}, is {held.get(name)}"
        for name, values in typed.items()
        if held.get(name) != values
    ]


async def refused(client: httpx.AsyncClient, office: Office, form: PageForm) -> tuple[bool, list[str]]:
    """Send one form to a controller that refuses; return whether an order was sent, and what was lost."""
    page = tree((await client.get(form.page)).text)
    everything, typed = sent_by(page, form.action)
    before = len(office.machine.orders)
    answer = await client.post(form.action, data=everything, headers=HTMX)
    is_ordered = len(office.machine.orders) > before
    if not is_ordered and answer.status_code < 400:
        return False, []
    return is_ordered, [f"{form.page} {form.action}: {what}" for what in lost(page, typed, answer)]


async def test_no_form_is_lost_by_a_refused_order(tmp_path: Path) -> None:
    office = Office(tmp_path)
    office.machine.rejects = Everything()
    ordered, found = set(), []
    async with office.app.router.lifespan_context(office.app), office.browser() as client:
        for form in await every_form(client):
            if form.method != "POST":
                continue
            is_ordered, told = await refused(client, office, form)
            found += told
            if is_ordered:
                ordered.add(re.sub(r"/T\d/", "/T1/", form.action.split("?")[0]))
    assert not found, "\n".join(found)
    assert len(ordered) > 45
