"""The document has an example for every body, which the body's own model takes."""

from collections.abc import Iterator
from typing import Any

from fastapi.dependencies.utils import get_dependant
from fastapi.routing import APIRoute
from pydantic import TypeAdapter

from app.web.described.examples import BODIES, COMMANDS
from tests.fakes import fake_app
from tests.web.test_openapi_lint import document

TOLD = document()
FILES = ("upload_photo", "upload_weather_file", "write_program_table")
"""Bodies that are files: their examples are not read by a model."""


def examples() -> Iterator[tuple[str, dict[str, Any], Any]]:
    for calls in TOLD["paths"].values():
        for call in calls.values():
            for content in call.get("requestBody", {}).get("content", {}).values():
                several = content.get("examples", {"": {"value": content.get("example")}})
                for one in several.values():
                    yield call["operationId"], content["schema"], one["value"]


EXAMPLES = list(examples())


def test_every_body_has_an_example_and_each_command_one() -> None:
    assert [name for name, _, example in EXAMPLES if example is None] == []
    assert {name for name, _, _ in EXAMPLES} == {*BODIES, "send_command"}
    commands = TOLD["paths"]["/api/v1/trackers/{tracker_id}/commands"]["post"]["requestBody"]
    assert set(COMMANDS) == set(commands["content"]["application/json"]["schema"]["discriminator"]["mapping"])


def test_every_example_fits_its_schema() -> None:
    from jsonschema import Draft202012Validator  # noqa: PLC0415 - builds grammars for seconds

    for name, schema, example in EXAMPLES:
        whole = {**schema, "components": TOLD["components"]}
        assert [one.message for one in Draft202012Validator(whole).iter_errors(example)] == [], name


def test_every_example_is_taken_by_its_model() -> None:
    routes = {
        one.name: one
        for one in fake_app().routes
        if isinstance(one, APIRoute) and one.path.startswith("/api/v1")
    }
    read = 0
    for name, _, example in EXAMPLES:
        if name not in FILES:
            (body,) = get_dependant(path=routes[name].path_format, call=routes[name].endpoint).body_params
            TypeAdapter(body.field_info.rebuild_annotation()).validate_python(example)
            read += 1
    assert read == len(EXAMPLES) - len(FILES)
