"""All of REST v1."""

from fastapi import APIRouter

from app.web.api import (
    access,
    accuracy,
    alarms,
    audit,
    certificate,
    commissioning,
    control,
    horizon,
    integrations,
    journal,
    motion,
    mounts,
    network,
    notifications,
    operations,
    papers,
    proofs,
    recordings,
    records,
    restores,
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
    training,
    users,
    weather,
    weather_sources,
)
from app.web.api.base import COMMON

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
    proofs.router,
    training.router,
    shows.router,
    recordings.router,
    simulations.router,
    studies.router,
    alarms.router,
    notifications.router,
    journal.router,
    audit.router,
    certificate.router,
    network.router,
    telemetry.router,
    stream.router,
    operations.router,
    restores.router,
)


def api_router() -> APIRouter:
    """Return the routes below /api/v1."""
    router = APIRouter(prefix="/api/v1", responses=COMMON)
    for part in ROUTERS:
        router.include_router(part)
    return router
