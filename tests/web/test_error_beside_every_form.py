"""On every page, each form, key, and part that asks has a place for an error where nothing is lost by it.

errors.js decides where an error stands; tests/browser/test_error_beside_form.py shows that it does so.
Here the same decision is taken on the HTML of every page.
"""

from collections.abc import Iterable
from datetime import timedelta
from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from app.store.store import PlannedShow
from app.tracker.programs.plan import ShowPlan
from tests.browser.every_page import EVERY_PAGE, SHOW_ID, Where
from tests.browser.panels import NOON, keep_study
from tests.browser.troubles import trouble
from tests.fake_data import SAMSUN
from tests.web.office import Office
from tests.web.tree import Tag, tree

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

FIELDS = frozenset({"input", "select", "textarea", "button"})
VERBS = ("hx-get", "hx-post", "hx-put", "hx-patch", "hx-delete")
NO_SWAP = '"noSwap":["204","304","4xx","5xx"]'
RULE = ["page.js", "htmx.min.js"]
"""The script that brings the rule runs before htmx."""
COMPUTED = {"/papers?show=yes": "/papers", EVERY_PAGE["accuracy"].path: "/accuracy"}
"""What is computed for seconds, and the page that asks for it."""


def asks(one: Tag) -> bool:
    """Return whether an element asks the panel for something by itself."""
    return any(verb in one.given for verb in VERBS)


def outcome(elements: Iterable[Tag], *, status: bool = False) -> Tag | None:
    """Return the first of these that is made for what comes of a key, with `status` a line of status too."""
    return next(
        (one for one in elements if one.is_a("outcome") or (status and one.given.get("role") == "status")),
        None,
    )


def form_of(one: Tag | None) -> Tag | None:
    """Return the form that an element is, or stands in."""
    while one is not None and one.name != "form":
        one = one.above
    return one


def aimed(page: Tag, source: Tag) -> Tag | None:
    """Return where a good answer goes; None if there is no such place."""
    how = source.given.get("hx-target", "this")
    if how == "this":
        return source
    if how.startswith("#"):
        return next((one for one in page.all if one.given.get("id") == how[1:]), None)
    assert how == "find .outcome", f"{source}: errors.js is not known to find {how}"
    return outcome(source.all)


def place(page: Tag, source: Tag) -> Tag | None:
    """Return the element that an error fills, None if one is made for it: `outcomeOf` of errors.js."""
    target = aimed(page, source)
    if target is not None and outcome([target], status=True):
        return target
    form = form_of(source)
    return outcome(source.below, status=True) if form is None else outcome(form.all)


def troubles(page: Tag, source: Tag) -> list[str]:
    """Return what is wrong with the place of an element's errors."""
    if aimed(page, source) is None:
        return ["its answer has no place"]
    if [name for name in source.given if name.startswith(("hx-status", "hx-on"))]:
        return ["says by itself where an error goes"]
    where = place(page, source)
    if source.given.get("hx-trigger") == "load" and where is None:
        return ["what it says while it waits stays beside the error"]
    if where is None:
        return []
    lost = [one for one in where.all if asks(one) or one.name in FIELDS]
    return [f"{one} is lost" for one in lost]


def visited(*wheres: Where) -> list[str]:
    paths = {leaf.path for leaf in EVERY_PAGE.values() if leaf.where in wheres}
    return sorted(COMPUTED.get(path, path) for path in paths)


async def furnish(client: httpx.AsyncClient, office: Office, folder: Path) -> None:
    """Give the panel what its pages can show."""
    keep_study(folder)
    plan = ShowPlan(
        SHOW_ID, NOON - timedelta(hours=8), NOON + timedelta(hours=7), timedelta(minutes=3), SAMSUN
    )
    office.machine.store.shows[SHOW_ID] = PlannedShow("T1", plan)
    signed = {"signatures": [{"role": "technician", "name": "Ada", "strokes": [[[9, 9], [500, 200]]]}]}
    for remark in ("Frost on the ground.", "After the sun check."):
        told = signed | {"confirmed": True, "remark": remark}
        answer = await client.post("/api/v1/trackers/T1/records", json=told)
        answer.raise_for_status()


@pytest.fixture
async def pages(tmp_path: Path) -> dict[str, str]:
    """Return the HTML of every page, by who looks and its address."""
    office = Office(tmp_path)
    people = {Where.ADMINISTRATOR: Role.ADMINISTRATOR, Where.VIEWER: Role.VIEWER}
    found = {}
    async with office.app.router.lifespan_context(office.app):
        async with office.browser() as local:
            await furnish(local, office, tmp_path)
            trouble(office.machine)
            for path in visited(Where.CALM, Where.TROUBLED):
                found[path] = await local.get(path)
        await office.hire(*people.values())
        for where, role in people.items():
            async with office.browser(await office.session(role)) as client:
                for path in visited(where):
                    found[f"{where} {path}"] = await client.get(path)
    assert {answer.status_code for answer in found.values()} <= {200, 403, 404, 422}
    return {name: answer.text for name, answer in found.items()}


async def test_every_form_key_and_part_has_a_place_for_its_errors(pages: dict[str, str]) -> None:
    found, asking, loading = [], 0, 0
    for name, text in pages.items():
        page = tree(text)
        sources = [one for one in page.all if asks(one)]
        found += [f"{name} {one}: {what}" for one in sources for what in troubles(page, one)]
        scripts = [one.given.get("src", "").split("?")[0].split("/")[-1] for one in page.all]
        if sources and (NO_SWAP not in text or [one for one in scripts if one in RULE] != RULE):
            found.append(f"{name} leaves its errors to htmx")
        asking += len(sources)
        loading += sum(one.given.get("hx-trigger") == "load" for one in sources)
    assert not found, "\n".join(found)
    assert asking > 300
    assert loading >= 5
