"""Every form of the panel, found by walking its pages, and values that nobody would type by accident."""

import random
import re
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from tests.golden.table import rows
from tests.web.tree import Tag, tree

SCRIPT = "<script>alert('hostile')</script>"
HOSTILE = (
    SCRIPT,
    f"\"'>{SCRIPT}<img src=x onerror=alert('hostile')>",
    "{{7*7}}{% include '/etc/passwd' %}",
    "'; DROP TABLE events; --",
    "../../../../etc/passwd",
    "x" * 20_000,
    "\x00",
    "nul\x00in\x00between",
    "\ud7ff\U0001f600\u202e",
    "",
    " ",
    "-1",
    "1e400",
    "NaN",
    "-Infinity",
    "99999999999999999999999999",
    "2026-02-30",
    "9999-12-31T23:59",
    "0001-01-01",
    "25:61",
    "[]",
    "true",
)
WORLD = tuple(
    row["text"]
    for table in sorted((Path(__file__).parents[1] / "golden" / "world").glob("*.csv"))
    for row in rows(f"world/{table.name}")
    if "text" in row
)
"""What people, maps, phones, and spreadsheets write: every text of the tables of the world."""
START = (
    "/",
    "/journal",
    "/site",
    "/simulate",
    "/studies",
    "/recordings",
    "/trackers/T1",
    "/users",
    "/tokens",
)
LEFT_OUT = re.compile(
    r"/(s/|api/|guide/|search|logout|setup|backup|diagnostics)|\.csv$|\.crt$|\.zip$|\?(show|ready|span|layout)="
)
"""Files, what signs out, and what is worked out for seconds and holds no further form."""

MOST_PAGES = 150


@dataclass(frozen=True, slots=True)
class PageForm:
    """Where a form sends what, and the values it holds."""

    page: str
    method: str
    action: str
    values: dict[str, str] = field(default_factory=dict, hash=False)
    ids: frozenset[str] = field(default=frozenset(), hash=False)
    """What can be found on its page by an id."""


def forms_of(page: str, root: Tag) -> list[PageForm]:
    """Return the forms of a page, and what else of it sends something."""
    found, ids = [], frozenset(one.given.get("id", "") for one in root.all)
    for one in root.all:
        fields = one.named("input", "select", "textarea", "button")
        values = {field.given["name"]: field.given.get("value", "") for field in reversed(fields)
                  if field.given.get("name")}  # fmt: skip
        if one.name == "form":
            method = one.given.get("method", "get").upper()
            found.append(PageForm(page, method, one.given.get("action") or page, values, ids))
        if path := one.given.get("hx-post"):
            found.append(PageForm(page, "POST", path, values, ids))
    return found


async def every_form(client: httpx.AsyncClient) -> list[PageForm]:
    """Walk the pages from the first ones on and return each form once."""
    waiting, seen, found = list(START), set(START), {}
    while waiting and len(seen) <= MOST_PAGES:
        page = waiting.pop(0)
        answer = await client.get(page, follow_redirects=True)
        if "text/html" not in answer.headers.get("content-type", ""):
            continue
        root = tree(answer.text)
        for form in forms_of(page, root):
            found.setdefault((form.method, form.action, tuple(form.values)), form)
        links = {one.given.get("href", "").split("#")[0] for one in root.named("a")}
        for link in sorted(links - seen):
            if link.startswith("/") and not LEFT_OUT.search(link):
                seen.add(link)
                waiting.append(link)
    return list(found.values())


def bad_value(chance: random.Random) -> str:
    """Return one text that is hostile, or that the world writes."""
    return chance.choice(chance.choice((HOSTILE, WORLD)))


def bad_values(form: PageForm, number: int, chance: random.Random) -> dict[str, str]:
    """Return what to send, in turn: every field hostile, one among right ones, or fields left out."""
    names = list(form.values) or ["unknown"]
    match number % 3:
        case 0:
            return {name: bad_value(chance) for name in names}
        case 1:
            return form.values | {chance.choice(names): bad_value(chance)}
        case _:
            return {name: bad_value(chance) for name in names if chance.random() < 0.5}


def hostile_in(text: str) -> str:
    """Return what a page gives back unescaped of what was sent; nothing is how it must be."""
    for mark in (SCRIPT, "onerror=alert('hostile')>", "<img src=x"):
        if mark in text:
            return mark
    return ""
