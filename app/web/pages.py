"""The pages of the panel: one router a subject, and the page that tells what went wrong."""

from starlette.requests import Request
from starlette.responses import Response

from app.base.message import Word
from app.web.features.access import (
    account,
    people,
    sign_in,
    token_page,
)
from app.web.features.alarms import alarms, journal, notifications
from app.web.features.commissioning import (
    drive,
    drive_tests,
    fault_injection,
    homing,
    sun_check,
)
from app.web.features.control import (
    control,
    mast,
    mode,
    overview,
    run,
    tracker,
)
from app.web.features.guide import guide_pages
from app.web.features.operations import (
    components,
    installed,
    language,
    restore,
)
from app.web.features.records import label, record_page, records_page
from app.web.features.science import accuracy, papers
from app.web.features.security import audit, certificate, network
from app.web.features.setup import (
    machine,
    mount,
    protections,
    service,
    settings,
)
from app.web.features.shows import recordings, show
from app.web.features.site import (
    clock,
    clock_shadow,
    horizon,
    location,
    site,
    sun_paths,
    trends,
)
from app.web.features.studies import (
    glance,
    simulate,
    step_programs,
    strategy,
    studies,
    study,
)
from app.web.http.problems import Problem
from app.web.shell import theme, wizard
from app.web.shell.contexts import Outcome, ProblemPage
from app.web.shell.frame import site_frame
from app.web.shell.render import page, wants_block

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
    mast.router,
    location.router,
    clock.router,
    clock_shadow.router,
    homing.pages,
    homing.router,
    mode.router,
    run.router,
    show.router,
    sun_check.router,
    record_page.router,
    records_page.router,
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
    guide_pages.router,
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
    title = Word(problem.title)
    frame = site_frame(request, title)
    whole = ProblemPage(frame=frame, title=title, detail=problem.detail, reasons=problem.reasons)
    return _with_headers(page(request, whole, status=problem.status), problem)


def _with_headers(response: Response, problem: Problem) -> Response:
    response.headers.update(problem.headers)
    return response
