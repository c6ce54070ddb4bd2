"""Every problem has a listed code with one status, and says where each wrong value is."""

from typing import Any

import httpx
import pytest

from app.base.own import PROGRAM, own_folder
from app.web.http.problems import ProblemCode, phrase

ERRORS_PAGE = own_folder("docs") / "reference" / "errors.md"


def test_each_code_is_told_somewhere_and_has_a_section_of_the_manual() -> None:
    told = "\n".join(path.read_text() for path in PROGRAM.rglob("*.py"))
    page = ERRORS_PAGE.read_text()
    for code in ProblemCode:
        assert f"ProblemCode.{code.name}" in told, code
        assert f"\n### `{code}`\n\n{code.status} {phrase(code.status)}. " in page
        assert code.type == f"/manual/reference/errors.html#{code}"


WRONG: list[tuple[str, str, Any, list[dict[str, str]]]] = [
    ("PATCH", "/trackers/T1", {"azimuth": {"speed_dps": -1}}, [{"pointer": "#/azimuth/speed_dps"}]),
    ("PATCH", "/trackers/T1", {"a/b~c": 1}, [{"pointer": "#/a~1b~0c"}]),
    ("POST", "/trackers/T1/commands", {"type": "step", "axis": "azimuth"}, [{"pointer": "#/delta_deg"}]),
    ("POST", "/trackers/T1/commands", {"type": "fly"}, [{"pointer": "#"}]),
    ("POST", "/trackers", {}, [{"pointer": "#/name"}, {"pointer": "#/tracker_id"}]),
    (
        "PUT",
        "/site/horizon",
        {"points": [{"azimuth_deg": 0, "elevation_deg": "5"}]},
        [{"pointer": "#/points/0/elevation_deg"}],
    ),
    ("GET", "/journal?limit=0", None, [{"parameter": "limit"}]),
    ("GET", f"/trackers/{'T' * 65}", None, [{"parameter": "tracker_id"}]),
]


@pytest.mark.parametrize(("method", "path", "body", "places"), WRONG)
async def test_a_wrong_value_is_pointed_at(
    client: httpx.AsyncClient, method: str, path: str, body: Any, places: list[dict[str, str]]
) -> None:
    answer = await client.request(method, f"/api/v1{path}", json=body)
    told = answer.json()
    assert (answer.status_code, told["code"]) == (422, "invalid_values")
    assert told["type"] == ProblemCode.INVALID_VALUES.type
    assert [{key: one[key] for key in one if key != "detail"} for one in told["errors"]] == places
    assert all(one["detail"] for one in told["errors"])
