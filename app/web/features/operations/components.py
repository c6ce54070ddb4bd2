"""Every component of the design system in every state and in each theme."""

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, plain
from app.base.permission import Permission
from app.tracker.values.reason import Reason
from app.web.features.operations.components_context import ComponentsPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.render import page
from app.web.shell.themes import THEMES

router = page_router(prefix="/components")
REASON = Reason("example", N_("The drive does not answer."), N_("Check its power and its cable."))


@router.get("")
@needs(Permission.CONFIGURE)
def components(request: Request) -> Response:
    """Show the components."""
    typed = Typed({"right": "41.2867", "wrong": "91,5", "choice": "second"})
    typed.errors["wrong"] = plain("Latitude must lie between 0 and 90 degrees, N or S.")
    context = ComponentsPage(
        frame=site_frame(request, "Components"),
        themes=THEMES,
        form=typed.form(("right", "wrong", "choice", "empty")),
        reasons=(REASON,),
    )
    return page(request, context)
