"""The recipe of an order in docs/develop/contributing.md, followed in a copy: four files, and it is there."""

from pathlib import Path

from tests.recipes.program_copy import followed

ORDER = '''
@dataclass(frozen=True, slots=True)
class Hold:
    """Switch tracking off and stay here."""

    within_deg: Annotated[float, Value(least=0, most=5, told="As near as this.")] = 1.0
    kind: Literal["hold"] = "hold"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, by=Interface.PEOPLE | Interface.MQTT)


Command = ('''
HANDLER = '''"""Staying where the tracker is."""

from app.tracker.commands.commands import Hold
from app.tracker.state.controller_state import ControllerState
from app.tracker.access.interlocks import Action, demand


def hold(state: ControllerState, command: Hold) -> None:
    """Switch tracking off, or raise `CommandRejected`."""
    demand(state, Action.HOLD)
    state.remember(tracking_on=False)
'''
EDITS = {
    "app/tracker/commands/commands.py": (
        ("\nCommand = (", ORDER),
        ("EndServiceMode\n)", "EndServiceMode | Hold\n)"),
    ),
    "app/tracker/access/interlocks.py": (
        ('    STOW = "stow"\n', '    STOW = "stow"\n    HOLD = "hold"\n'),
        ("    Action.STOP: (),\n", "    Action.STOP: (),\n    Action.HOLD: (reachable, remote),\n"),
    ),
    "app/tracker/orders.py": (
        ("    Home,\n", "    Hold,\n    Home,\n"),
        ("    jogging,\n", "    holding_still,\n    jogging,\n"),
        (
            "        _plain(Park, moving.park),\n",
            "        _plain(Park, moving.park),\n        _given(Hold, holding_still.hold),\n",
        ),
    ),
}
NEW = {"app/tracker/activities/holding_still.py": HANDLER}
PROOF = """
from datetime import UTC, datetime

from app.gateway.mqtt_commands import MESSAGES
from app.link.codec import Execute, decode_request, encode_request
from app.tracker.commands.commands import CommandRejected, Hold
from app.tracker.settings.config import TrackerConfig
from app.tracker.controller import Controller
from app.tracker.memory.memory import TrackerMemory
from app.web.features.control.motion_api import AnyCommand
from pydantic import TypeAdapter, ValidationError
from tests.tracker.scripted import CAPABILITIES

said = b'{"type": "hold", "within_deg": 2}'
assert TypeAdapter(AnyCommand).validate_json(said).command() == Hold(2.0), "REST"
try:
    TypeAdapter(AnyCommand).validate_json(b'{"type": "hold", "within_deg": 6}')
except ValidationError:
    pass
else:
    raise AssertionError("REST takes what is out of its bounds")
assert MESSAGES.validate_json(said[:-1] + b', "client": "scada"}').command() == Hold(2.0), "MQTT"
sent = Execute(1, Hold(2.0), "anna", "T1", None, None, 1.0)
assert decode_request(encode_request(sent)[4:]) == sent, "link"
try:
    Controller(TrackerConfig("T1", "T1"), TrackerMemory(), CAPABILITIES).handle(Hold(), datetime.now(UTC))
except CommandRejected as rejected:
    print(*(reason.code for reason in rejected.reasons))
"""


def test_an_order_is_added_in_four_files(tmp_path: Path) -> None:
    assert len({*EDITS, *NEW}) <= 4
    assert followed(tmp_path, EDITS, NEW, PROOF) == ["drive_unreachable"]
