"""Whether there is an account of a name is told by no answer and by no work that is done for it."""

from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from app.base.clock import VirtualClock
from tests.fake_data import NOON
from tests.fault_result import FaultResult
from tests.web.office import Office

Told = tuple[int, str, str | None, int]
THERE = ["viewer-1", "operator-1", "engineer-1"]
NOWHERE = ["zzz1", "zzz2", "fresh9"]


async def told(folder: Path, names: list[str], path: str) -> list[Told]:
    """Return what four wrong passwords for each name are answered, and how often a password was hashed."""
    office = Office(folder, clock=VirtualClock(NOON))
    await office.hire(Role.VIEWER, Role.OPERATOR, Role.ENGINEER)
    for name in ("viewer", "operator", "engineer"):
        await office.session(name)
    found = []
    async with office.browser() as browser:
        for name in names:
            for _ in range(4):
                before = office.hasher.checked
                answer = await sign_in(browser, path, name)
                text = answer.text.replace(name, "NAME")
                found.append(
                    (
                        answer.status_code,
                        text,
                        answer.headers.get("retry-after"),
                        office.hasher.checked - before,
                    )
                )
    return found


async def sign_in(browser: httpx.AsyncClient, path: str, name: str) -> httpx.Response:
    typed = {"name": name, "password": "wrong-but-long-enough"}
    if path.startswith("/api/"):
        return await browser.post(path, json=typed)
    return await browser.post(path, data=typed)


@pytest.mark.fault(95)
@pytest.mark.parametrize("path", ["/api/v1/session", "/login"])
async def test_names_with_and_without_an_account_are_answered_alike(
    tmp_path: Path, path: str, fault: FaultResult
) -> None:
    """Somebody is signed in from the very address of the guesses: that too must not show."""
    there = await told(tmp_path / "there", THERE, path)
    nowhere = await told(tmp_path / "nowhere", NOWHERE, path)
    assert [(status, wait, hashed) for status, _, wait, hashed in there] == [
        (status, wait, hashed) for status, _, wait, hashed in nowhere
    ]
    assert there == nowhere
    assert {status for status, _, _, _ in there} == {401, 429}
    assert {hashed for status, _, _, hashed in there if status == 401} == {1}
    fault.prevented("every typed name is counted and hashed alike")
    assert "The name or the password is wrong." in next(text for status, text, _, _ in there if status == 401)
    fault.shows("The name or the password is wrong.")
    fault.recovers("nothing was lost")
