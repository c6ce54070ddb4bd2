"""The API's document through a linter of its standard, without a complaint."""

from collections.abc import Iterator

import orjson
from openapi_spec_validator import OpenAPIV31SpecValidator

from app.web.documented import DOCUMENT


def faults() -> Iterator[str]:
    """Yield the linter's complaints."""
    for error in OpenAPIV31SpecValidator(orjson.loads(DOCUMENT.read_bytes())).iter_errors():
        yield f"docs/openapi.json: {error.message}: correct the route, then run python -m app.web.openapi."
