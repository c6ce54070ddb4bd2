"""The API behaves as its document says; `make check` asks whether the document is current."""

import json
from functools import cache
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web.openapi import DOCUMENT
from tests.amount import amount
from tests.fakes import fake_app
from tests.patience import PATIENCE_S

EXAMPLES = amount(1, 8)
LEFT_OUT = (
    *("stream", "simulations", "backup", "accuracy", "papers"),
    *("studies/comparison", "studies/programs", "strategy/day"),
)
"""Streams do not end, and the others compute for seconds."""
TOLD: dict[str, dict[str, Any]] = json.loads(DOCUMENT.read_text())
OPERATIONS = [
    (path, method)
    for path, calls in TOLD["paths"].items()
    for method in calls
    if not any(part in path for part in LEFT_OUT)
]


@cache
def app() -> ASGIApp:
    """Return a panel that takes every request for one of somebody at its own computer."""
    panel = fake_app()

    async def from_here(scope: Scope, receive: Receive, send: Send) -> None:
        await panel(scope | {"client": ("127.0.0.1", 50000)}, receive, send)

    return from_here


@cache
def schema() -> Any:
    """Return the document as schemathesis reads it, which is loaded where it is used."""
    import schemathesis  # noqa: PLC0415 - takes half a second of every worker that collects

    off = {"enabled": False}
    phases = {"coverage": off, "examples": off, "stateful": off}
    config = schemathesis.config.SchemathesisConfig.from_dict({"phases": phases})
    return schemathesis.openapi.from_dict(TOLD, config=config)


@cache
def checks() -> list[Any]:
    from schemathesis.checks import not_a_server_error  # noqa: PLC0415
    from schemathesis.specs.openapi import checks as of_document  # noqa: PLC0415

    return [
        not_a_server_error,
        of_document.status_code_conformance,
        of_document.content_type_conformance,
        of_document.response_schema_conformance,
    ]


@pytest.mark.parametrize(("path", "method"), OPERATIONS)
def test_the_api_does_what_its_document_says(path: str, method: str) -> None:
    @given(schema()[path][method].as_strategy())
    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        derandomize=True,
        database=None,
        phases=(Phase.generate,),
    )
    def judged(case: Any) -> None:
        case.call_and_validate(
            app=app(), checks=checks(), base_url="http://127.0.0.1:8010", timeout=PATIENCE_S
        )

    judged()
