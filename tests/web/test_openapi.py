"""The API behaves as its document says; `make check` asks whether the document is current."""

import json

import schemathesis
from hypothesis import HealthCheck, Phase, settings
from schemathesis.checks import not_a_server_error
from schemathesis.config import SchemathesisConfig
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from starlette.types import Receive, Scope, Send

from app.web.openapi import DOCUMENT
from tests.amount import amount
from tests.fakes import fake_app
from tests.patience import PATIENCE_S

EXAMPLES = amount(1, 8)
LEFT_OUT = "stream|simulations|backup|accuracy|papers|studies/comparison|studies/programs|strategy/day"
"""Streams do not end, and the others compute for seconds."""

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]


OFF = {"enabled": False}
CONFIG = SchemathesisConfig.from_dict({"phases": {"coverage": OFF, "examples": OFF, "stateful": OFF}})
APP = fake_app()


async def from_here(scope: Scope, receive: Receive, send: Send) -> None:
    """Ask as somebody at the panel's own computer."""
    await APP(scope | {"client": ("127.0.0.1", 50000)}, receive, send)


schema = schemathesis.openapi.from_dict(json.loads(DOCUMENT.read_text()), config=CONFIG)


@schema.exclude(path_regex=LEFT_OUT).parametrize()
@settings(
    max_examples=EXAMPLES,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    derandomize=True,
    database=None,
    phases=(Phase.generate,),
)
def test_the_api_does_what_its_document_says(case: schemathesis.Case) -> None:
    case.call_and_validate(app=from_here, checks=CHECKS, base_url="http://127.0.0.1:8010", timeout=PATIENCE_S)
