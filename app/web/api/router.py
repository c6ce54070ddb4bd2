"""All of REST v1."""

from fastapi import APIRouter
from starlette.routing import BaseRoute

from app.web.api import (
    access,
    accuracy,
    alarms,
    audit,
    backups,
    certificate,
    commissioning,
    control,
    drive_tests,
    fault_injection,
    horizon,
    integrations,
    journal,
    motion,
    mounts,
    network,
    notifications,
    operations,
    papers,
    recordings,
    records,
    settings_lock,
    shows,
    simulations,
    site,
    strategies,
    stream,
    studies,
    sun,
    telemetry,
    trackers,
    users,
    weather,
    weather_sources,
)
from app.web.api.base import COMMON, ROOT, operation_id

ROUTERS = (
    access.router,
    users.router,
    site.router,
    horizon.router,
    weather.router,
    weather_sources.router,
    integrations.router,
    sun.router,
    accuracy.router,
    papers.router,
    trackers.router,
    mounts.router,
    strategies.router,
    commissioning.router,
    records.router,
    control.router,
    settings_lock.router,
    motion.router,
    drive_tests.router,
    fault_injection.router,
    shows.router,
    recordings.router,
    simulations.router,
    studies.router,
    alarms.router,
    notifications.router,
    journal.router,
    audit.router,
    backups.router,
    certificate.router,
    network.router,
    telemetry.router,
    stream.router,
)


def api_routes() -> list[BaseRoute]:
    """Return the routes below /api/v1; those of operations stand at the root too, and are included here."""
    shared = APIRouter(prefix=ROOT, responses=COMMON, generate_unique_id_function=operation_id)
    shared.include_router(operations.router)
    return [*(route for part in ROUTERS for route in part.routes), *shared.routes]
