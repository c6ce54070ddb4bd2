"""The pages of the panel: one router a subject, and the page that tells what went wrong."""

from starlette.requests import Request
from starlette.responses import Response

from app.web.contexts import Outcome, ProblemPage
from app.web.errors import Problem
from app.web.ui import (
    account,
    accuracy,
    alarms,
    audit,
    certificate,
    clock,
    components,
    control,
    drive,
    drive_tests,
    fault_injection,
    glance,
    guide,
    homing,
    horizon,
    installed,
    journal,
    label,
    language,
    location,
    machine,
    mode,
    mount,
    network,
    notifications,
    overview,
    papers,
    people,
    protections,
    record,
    recordings,
    records,
    restore,
    run,
    service,
    settings,
    show,
    sign_in,
    simulate,
    site,
    step_programs,
    strategy,
    studies,
    study,
    sun_check,
    sun_paths,
    theme,
    token_page,
    tracker,
    trends,
    wizard,
)
from app.web.ui.frame import site_frame
from app.web.ui.render import page, wants_block

ROUTERS = (
    overview.router,
    language.router,
    theme.router,
    installed.router,
    sign_in.router,
    account.router,
    people.router,
    token_page.router,
    tracker.router,
    control.router,
    location.router,
    clock.router,
    homing.pages,
    homing.router,
    mode.router,
    run.router,
    show.router,
    sun_check.router,
    record.router,
    records.router,
    label.router,
    settings.router,
    strategy.router,
    protections.router,
    machine.router,
    service.router,
    mount.router,
    drive.router,
    drive_tests.router,
    fault_injection.router,
    recordings.router,
    simulate.router,
    step_programs.router,
    glance.router,
    studies.router,
    study.router,
    accuracy.router,
    papers.router,
    alarms.router,
    notifications.router,
    guide.router,
    components.router,
    journal.router,
    audit.router,
    certificate.router,
    network.router,
    restore.router,
    site.router,
    horizon.router,
    sun_paths.router,
    trends.router,
    wizard.router,
)


def error_page(request: Request, problem: Problem) -> Response:
    """Say what went wrong: below the key that was pressed, or on a page of its own."""
    if wants_block(request):
        context = Outcome(done=None, detail=problem.detail, reasons=problem.reasons)
        return _with_headers(page(request, context, status=problem.status), problem)
    frame = site_frame(request, problem.title)
    whole = ProblemPage(frame=frame, title=problem.title, detail=problem.detail, reasons=problem.reasons)
    return _with_headers(page(request, whole, status=problem.status), problem)


def _with_headers(response: Response, problem: Problem) -> Response:
    response.headers.update(problem.headers)
    return response
