"""The way forward of a step saves only for those who may, also once the steps were renewed."""

import re

import pytest

from app.access.roles import Role
from tests.web.office import Office

ROOT = "/trackers/T1/commissioning"
SAVE = re.compile(r'<button class="key key-primary" form="step-form"( disabled)?>')
SAVED_BY = {"location": Role.ENGINEER, "clock": Role.ENGINEER, "mode": Role.OPERATOR}


@pytest.mark.parametrize("step", SAVED_BY)
async def test_a_renewed_step_is_saved_by_those_who_may(office: Office, step: str) -> None:
    for role, is_off in ((Role.VIEWER, True), (SAVED_BY[step], False)):
        async with office.browser(await office.session(role.value)) as browser:
            asked = {"here": f"{ROOT}/{step}"}
            found = SAVE.search((await browser.get(f"{ROOT}/progress/{step}", params=asked)).text)
        assert found is not None
        assert (found[1] is not None) is is_off, role
