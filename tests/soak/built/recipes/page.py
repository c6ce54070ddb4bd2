"""A page: what its recipe changes and adds, and the proof that it works."""

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
from pathlib import Path

from app.access.roles import Role
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
            assert (await viewer.get("/trackers/T1/greeting")).status_code == 200


Path("office").mkdir()
"""
