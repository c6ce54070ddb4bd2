"""All of REST v1."""

from fastapi import APIRouter
from starlette.routing import BaseRoute

from app.web.api import sun, trackers
from app.web.api.base import COMMON, ROOT, operation_id
from app.web.features.access import access_api, users_api
from app.web.features.alarms import alarms_api, journal_api, notifications_api
from app.web.features.commissioning import drive_tests_api, fault_injection_api
from app.web.features.control import control_api, motion_api, stream_api
from app.web.features.operations import backups_api, integrations_api, operations_api
from app.web.features.records import commissioning_api, records_api
from app.web.features.science import accuracy_api, papers_api
from app.web.features.security import audit_api, certificate_api, network_api
from app.web.features.setup import mounts_api, settings_lock_api
from app.web.features.shows import recordings_api, shows_api, telemetry_api
from app.web.features.site import (
    horizon_api,
    site_api,
    weather_api,
    weather_sources_api,
)
from app.web.features.studies import simulations_api, strategies_api, studies_api

ROUTERS = (
    access_api.router,
    users_api.router,
    site_api.router,
    horizon_api.router,
    weather_api.router,
    weather_sources_api.router,
    integrations_api.router,
    sun.router,
    accuracy_api.router,
    papers_api.router,
    trackers.router,
    mounts_api.router,
    strategies_api.router,
    commissioning_api.router,
    records_api.router,
    control_api.router,
    settings_lock_api.router,
    motion_api.router,
    drive_tests_api.router,
    fault_injection_api.router,
    shows_api.router,
    recordings_api.router,
    simulations_api.router,
    studies_api.router,
    alarms_api.router,
    notifications_api.router,
    journal_api.router,
    audit_api.router,
    backups_api.router,
    certificate_api.router,
    network_api.router,
    telemetry_api.router,
    stream_api.router,
)


def api_routes() -> list[BaseRoute]:
    """Return the routes below /api/v1; those of operations stand at the root too, and are included here."""
    shared = APIRouter(prefix=ROOT, responses=COMMON, generate_unique_id_function=operation_id)
    shared.include_router(operations_api.router)
    return [*(route for part in ROUTERS for route in part.routes), *shared.routes]
