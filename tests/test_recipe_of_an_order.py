"""The recipe of an order in docs/develop/contributing.md, followed in a copy: four files, and it is there."""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
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
NEW = "app/tracker/activities/holding_still.py"
PROOF = """
from datetime import UTC, datetime

import app
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
    print(app.__path__[0], *(reason.code for reason in rejected.reasons))
"""


def test_an_order_is_added_in_four_files(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "app", tmp_path / "app", ignore=shutil.ignore_patterns("__pycache__", "locale"))
    for folder in ("docs", "static", "templates", "tests", "alembic"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    (tmp_path / NEW).write_text(HANDLER)
    for name, edits in EDITS.items():
        text = (tmp_path / name).read_text()
        for before, after in edits:
            assert before in text, f"{name} has no {before!r}: change the recipe too"
            text = text.replace(before, after, 1)
        (tmp_path / name).write_text(text)
    assert len({*EDITS, NEW}) <= 4
    told = subprocess.run(
        (sys.executable, "-c", PROOF), cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert told.stdout.split() == [str(tmp_path / "app"), "drive_unreachable"], told.stderr
