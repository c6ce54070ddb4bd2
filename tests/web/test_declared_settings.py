"""A setting is declared once: its bounds, label, unit, and default reach form, API, check, and search."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
from annotated_types import Ge, Le
from httpx import AsyncClient
from pydantic import TypeAdapter, ValidationError

from app.base.adapter import adapter
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.declared import Setting, check, declared
from app.web.api.changes import change_of, given
from app.web.features.guide.search_index import SETTING_PAGES, WRITTEN_OUT, index
from app.web.features.setup.protection_forms import fixed, groups, stows
from app.web.shell.forms import Typed
from app.web.shell.setting_forms import field_name, row, typed_settings

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "golden" / "tracker_config.json"
NUMBERS = {path: one for path, one in declared(TrackerConfig).items() if one.is_number}
BY_HAND = (
    "app/web/features/setup/settings.py",
    "app/web/features/setup/protections.py",
    "app/web/features/setup/protection_forms.py",
)
LABELS = sorted({one.label for path, one in NUMBERS.items() if path.split(".")[0] not in WRITTEN_OUT})


@dataclass(frozen=True, slots=True)
class Wind:
    """A copy of one limit, with another bound."""

    gust_mps: Annotated[float, Ge(2), Le(33), Setting("Gust threshold", "m/s", help="Over 3 s.")] = 17.0

    def __post_init__(self) -> None:
        check(self)


def test_the_stored_form_and_every_default_are_as_before() -> None:
    config = TrackerConfig("T1", "North field")
    assert adapter(TrackerConfig).dump_python(config, mode="json") == json.loads(GOLDEN.read_text())


def test_every_number_has_bounds_and_its_default_lies_within() -> None:
    for path, one in NUMBERS.items():
        assert one.label, path
        assert -1e10 < one.least < one.most < 1e10, path
        assert one.default is None or one.holds(one.default), path


def test_no_bound_and_no_label_is_written_again() -> None:
    for name in BY_HAND:
        assert re.findall(r"\.(?:number|whole)\(.*\d", (ROOT / name).read_text()) == [], name
    for name in ("settings.html", "protections.html", "machine.html"):
        source = (ROOT / "templates" / name).read_text()
        again = [one for one in LABELS if f"text_field(form.{one}" in source or f'_("{one}"), "' in source]
        assert again == [], name


def test_a_changed_bound_reaches_check_form_and_api() -> None:
    with pytest.raises(ValueError, match=r"Gust threshold must be between 2 and 33\."):
        Wind(34.0)
    assert row(declared(Wind)["gust_mps"]).hint == "Over 3 s. 2 to 33, usual 17."
    typed = Typed({"gust_mps": "34"})
    assert typed_settings(typed, Wind) is None
    assert typed.errors == {"gust_mps": "Gust threshold must be between 2 and 33."}
    schema = change_of(Wind).model_json_schema()["properties"]["gust_mps"]["anyOf"][0]
    assert (schema["minimum"], schema["maximum"], schema["title"], schema["x-unit"]) == (
        2, 33, "Gust threshold", "m/s",
    )  # fmt: skip
    with pytest.raises(ValidationError, match="between 2 and 33"):
        TypeAdapter(Wind).validate_python({"gust_mps": 1.9})


def test_null_is_a_value_only_where_there_may_be_none() -> None:
    kind: Any = TrackerConfig
    body = {"name": None, "drive": {"unit": None, "azimuth": {"unit": None}}, "mount": {"rows": None}}
    assert given(change_of(kind).model_validate(body)) == {
        "drive": {"azimuth": {"unit": None}},
        "mount": {"rows": None},
    }


def test_the_search_finds_every_setting_that_no_template_writes_out() -> None:
    found = {entry.title for entry, _ in index()}
    made = [one.title for path, one in NUMBERS.items() if path.split(".")[0] not in WRITTEN_OUT]
    assert [title for title in made if title not in found] == []


def test_the_protections_page_has_every_setting() -> None:
    shown = {one.name for group in (*groups(), *stows()) for one in group.settings}
    shown |= {one.name for one in fixed()}
    paths = (path.removeprefix("protection.") for path in declared(TrackerConfig) if "protection." in path)
    assert shown == {path.replace(".", "_") for path in paths}


DRAWN_ELSEWHERE = re.compile(r"actuator|^(regions|strategy)$")
"""On the pages of mount and strategy, and as corners of polygons."""
OWN_PAGES = tuple(f"{root}." for root in (*SETTING_PAGES, *WRITTEN_OUT))
ON_PAGES = {
    page: [path.removeprefix(f"{root}.") for path in declared(TrackerConfig) if path.startswith(f"{root}.")]
    for root, page in SETTING_PAGES.items()
} | {"/settings": [path for path in declared(TrackerConfig) if not path.startswith(OWN_PAGES)]}


@pytest.mark.parametrize("page", ON_PAGES)
async def test_every_setting_has_one_field_on_its_page(client: AsyncClient, page: str) -> None:
    told = (await client.get(f"/trackers/T1{page}")).text
    form = re.search(rf'<form[^>]*id="{page[1:]}-form".*?</form>', told, re.DOTALL)
    assert form is not None
    fields = re.findall(r'<(?:input(?! type="hidden")|select|textarea)[^>]* name="([^"]+)"', form[0])
    names = [field_name(path) for path in ON_PAGES[page] if not DRAWN_ELSEWHERE.search(path)]
    assert {name: fields.count(name) for name in names if fields.count(name) != 1} == {}
