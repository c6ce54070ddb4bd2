"""How the machine's other doors are doing: SunSpec and MQTT."""

from app.base.permission import Permission
from app.link.messages import MachineUnreachable
from app.link.metrics import GatewayMetrics
from app.web.api.base import Page, api_router, whole
from app.web.http.needs import needs
from app.web.services.counting import counted
from app.web.shell.deps import MachineDep

router = api_router(prefix="/site/integrations", tags=["site"])


@router.get("", summary="The state of every integration")
@needs(Permission.READ)
async def read_integrations(machine: MachineDep) -> Page[GatewayMetrics]:
    """Return for SunSpec and MQTT whether they are open, where, for whom, and what went wrong last."""
    metrics = await counted(machine)
    if metrics is None:
        raise MachineUnreachable
    return whole(metrics.gateways)
