"""The page that offers a backup while the database is damaged."""

from typing import Annotated

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, say
from app.base.permission import Permission
from app.web.features.operations.restore_contexts import RestorePage
from app.web.features.operations.restoring import choice
from app.web.features.operations.restoring import restore as hand_over
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/restore")


@router.get("")
@needs(Permission.ADMINISTER)
def offer(request: Request, built: PanelDep) -> Response:
    """Say whether the database is damaged, and which backups there are."""
    return _answer(request, built)


@router.post("")
@needs(Permission.ADMINISTER, proven=True)
async def restore(
    request: Request, built: PanelDep, file: Annotated[str, Form(max_length=200)] = ""
) -> Response:
    """Hand the chosen backup over; the controller service starts again on it."""
    found = await run_in_threadpool(hand_over, built, file, built.site_now())
    return _answer(
        request,
        built,
        say("The backup of {site_name} is being restored: reload in a moment.", site_name=found.site_name),
    )


def _answer(request: Request, built: PanelDep, done: str = "") -> Response:
    found = choice(built)
    frame = site_frame(request, N_("Restore"))
    context = RestorePage(frame=frame, damage=found.damage, backups=found.backups, done=done)
    return page(request, context)
