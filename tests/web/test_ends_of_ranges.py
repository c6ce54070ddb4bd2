"""Every parameter of every call at the ends of its range and just beyond: never a mistake of the panel."""

import json

import httpx
import pytest

from app.store.migrations import upgrade
from app.web.openapi import DOCUMENT as KEPT
from app.web.services.simulations import BUSY, Busy, Simulations
from app.web.services.studies import Studies
from tests.amount import SOAK
from tests.fakes import PORT, fake_app
from tests.fault_result import FaultResult
from tests.web.ends import Case, Document
from tools.fuzz import LastingMachine

DOCUMENT = Document(json.loads(KEPT.read_text()), {"tracker_id": "T1", "recording_id": "show-1"})
ENDLESS = "/api/v1/stream"
COMPUTES = "/api/v1/studies/programs"
"""Looks for programs in the panel's own thread for seconds; its values are those of `/studies`."""
PARTS = 8
PROBLEM = "application/problem+json"


def wrong(answer: httpx.Response) -> str:
    """Return what is wrong with an answer, nothing if whoever asked can go on."""
    if answer.headers.get("connection") == "close" or answer.status_code == 500:
        return f"{answer.status_code} that breaks the connection"
    if answer.status_code < 400:
        return ""
    if answer.headers.get("content-type") != PROBLEM:
        return f"{answer.status_code} as {answer.headers.get('content-type')}"
    told = answer.json()
    sentence = told.get("detail") or told.get("title") or ""
    return "" if sentence.strip() else f"{answer.status_code} without a sentence: {told}"


async def busy(*_: object) -> None:
    """Stand for the workers that compute: what comes so far was accepted."""
    raise Busy(BUSY)


def part(number: int) -> list[Case]:
    """Return the requests of every eighth operation, in the gate every sixth of them."""
    operations = [one for one in DOCUMENT.operations() if one[1] not in (ENDLESS, COMPUTES)]
    cases = [case for one in operations[number::PARTS] for case in DOCUMENT.cases(*one)]
    return cases if SOAK else cases[number % 6 :: 6]


@pytest.mark.fault(96)
@pytest.mark.parametrize("number", range(PARTS))
async def test_no_value_at_the_end_of_a_range_is_a_mistake_of_the_panel(
    number: int, monkeypatch: pytest.MonkeyPatch, fault: FaultResult
) -> None:
    monkeypatch.setattr(Simulations, "_work", busy)
    monkeypatch.setattr(Studies, "_answer", busy)
    app = fake_app(LastingMachine())
    upgrade(app.state.panel.settings.url)
    found, cases = [], part(number)
    transport = httpx.ASGITransport(app, raise_app_exceptions=False)
    async with (
        app.router.lifespan_context(app),
        httpx.AsyncClient(transport=transport, base_url=f"http://127.0.0.1:{PORT}") as client,
    ):
        for case in cases:
            answer = await client.request(case.method, case.path, headers=case.headers, content=case.body)
            if trouble := wrong(answer):
                found.append(f"{case}: {trouble}")
    assert not found, f"{len(found)} of {len(cases)}:\n" + "\n".join(found[:20])
    fault.prevented("refused before it is used")
    fault.shows("a problem with a sentence")
    fault.recovers("with values within their range")
