"""How the machine's other doors are doing: SunSpec and MQTT."""

from app.link.messages import MachineUnreachable
from app.link.metrics import GatewayMetrics
from app.web.api.base import api_router
from app.web.deps import MachineDep
from app.web.metrics import counted

router = api_router(prefix="/site/integrations", tags=["site"])


@router.get("", summary="The state of every integration")
async def read_integrations(machine: MachineDep) -> list[GatewayMetrics]:
    """Return for SunSpec and MQTT whether they are open, where, for whom, and what went wrong last."""
    metrics = await counted(machine)
    if metrics is None:
        raise MachineUnreachable
    return list(metrics.gateways)
