"""Every component of the design system in every state and in each theme."""

from starlette.requests import Request
from starlette.responses import Response

from app.tracker.reason import Reason
from app.web.components_context import ComponentsPage
from app.web.late_routes import page_router
from app.web.ui.forms import Typed
from app.web.ui.frame import site_frame
from app.web.ui.render import page
from app.web.ui.themes import THEMES

router = page_router(prefix="/components")
REASON = Reason("example", "The drive does not answer.", "Check its power and its cable.")


@router.get("")
def components(request: Request) -> Response:
    """Show the components."""
    typed = Typed({"right": "41.2867", "wrong": "91,5", "choice": "second"})
    typed.errors["wrong"] = "Latitude must lie between 0 and 90 degrees, N or S."
    context = ComponentsPage(
        frame=site_frame(request, "Components"),
        themes=THEMES,
        form=typed.form(("right", "wrong", "choice", "empty")),
        reasons=(REASON,),
    )
    return page(request, context)
