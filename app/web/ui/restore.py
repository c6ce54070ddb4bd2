"""The page that offers a backup while the database is damaged."""

from typing import Annotated

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.web.deps import PanelDep
from app.web.late_routes import page_router
from app.web.restore_contexts import RestorePage
from app.web.restoring import choice
from app.web.restoring import restore as hand_over
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = page_router(prefix="/restore")


@router.get("")
def offer(request: Request, built: PanelDep) -> Response:
    """Say whether the database is damaged, and which backups there are."""
    return _answer(request, built)


@router.post("")
async def restore(
    request: Request, built: PanelDep, file: Annotated[str, Form(max_length=200)] = ""
) -> Response:
    """Hand the chosen backup over; the controller service starts again on it."""
    found = await run_in_threadpool(hand_over, built, file, built.clock.now())
    return _answer(request, built, f"The backup of {found.site_name} is being restored: reload in a moment.")


def _answer(request: Request, built: PanelDep, done: str = "") -> Response:
    found = choice(built)
    frame = site_frame(request, "Restore")
    context = RestorePage(frame=frame, damage=found.damage, backups=found.backups, done=done)
    return page(request, context)
