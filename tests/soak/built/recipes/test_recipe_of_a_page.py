"""The recipe of a page in docs/develop/contributing.md, followed in a copy: four files, and it is found."""

from pathlib import Path

import pytest

from tests.soak.built.recipes.program_copy import followed

MODULE = '''"""The page that greets."""

from dataclasses import dataclass
from typing import ClassVar

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Frame
from app.web.shell.frame import tracker_frame
from app.web.shell.render import page

router = page_router(prefix="/trackers/{tracker_id}/greeting")


@dataclass(frozen=True, slots=True)
class GreetingPage:
    """What greets."""

    template: ClassVar[str] = "greeting.html"

    frame: Frame


@router.get("")
@needs(Permission.READ)
async def greet(request: Request, tracker_id: str) -> Response:
    """Greet."""
    return page(request, GreetingPage(tracker_frame(request, tracker_id, N_("Greeting"))))
'''
TEMPLATE = """{% extends "_frame.html" %}
{% block content %}
<h1 id="heading" tabindex="-1">{{ _("Greeting") }}</h1><p>{{ frame.name }}</p>
{% endblock %}
"""
NEW = {"app/web/features/control/greeting.py": MODULE, "templates/greeting.html": TEMPLATE}
EDITS = {
    "app/web/pages.py": (
        ("    control,\n    mast,\n", "    control,\n    greeting,\n    mast,\n"),
        ("    mast.router,\n", "    mast.router,\n    greeting.router,\n"),
    ),
    "app/web/features/guide/search_index.py": (
        (
            '    (N_("Label"), "/label"',
            '    (N_("Greeting"), "/greeting", N_("It greets")),\n    (N_("Label"), "/label"',
        ),
    ),
}
PROOF = """
FOR_A_VIEWER = 200
import asyncio
from pathlib import Path

from app.access.roles import Role
from tests.fakes import FakeMachine, FakeReader, fake_app, serving
from tests.web.office import Office


async def seen():
    async with serving(fake_app(FakeMachine(), FakeReader())) as client:
        page = await client.get("/trackers/T1/greeting")
        assert page.status_code == 200 and "<p>T1 North field</p>" in page.text, page.text
        found = (await client.get("/search?q=greeting")).text
        assert "/trackers/T1/greeting" in found, "the search"
    office = Office(Path("office"))
    async with office.app.router.lifespan_context(office.app):
        await office.hire(Role.VIEWER)
        async with office.browser() as stranger:
            refused = await stranger.get("/trackers/T1/greeting")
            assert refused.status_code != 200 and "North field" not in refused.text, "who is not signed in"
        async with office.browser(await office.session("viewer")) as viewer:
            assert (await viewer.get("/trackers/T1/greeting")).status_code == FOR_A_VIEWER


Path("office").mkdir()
asyncio.run(seen())
"""


def test_a_page_is_added_in_four_files(tmp_path: Path) -> None:
    assert len({*EDITS, *NEW}) <= 5
    followed(tmp_path, EDITS, NEW, PROOF)


def test_a_page_refuses_who_lacks_its_permission(tmp_path: Path) -> None:
    for_administrators = MODULE.replace("@needs(Permission.READ)", "@needs(Permission.ADMINISTER)")
    new = NEW | {"app/web/features/control/greeting.py": for_administrators}
    followed(tmp_path, EDITS, new, PROOF.replace("FOR_A_VIEWER = 200", "FOR_A_VIEWER = 403"))


def test_a_page_that_names_no_permission_is_not_served(tmp_path: Path) -> None:
    open_to_all = MODULE.replace("@needs(Permission.READ)\n", "")
    with pytest.raises(AssertionError, match="greet"):
        followed(tmp_path, EDITS, NEW | {"app/web/features/control/greeting.py": open_to_all}, PROOF)
