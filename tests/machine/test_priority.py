"""Real-time scheduling, as the kernel has it of a process that asked for it."""

import json
import os
import resource
import subprocess
import sys

import pytest

from app.machine.process import FIFO_PRIORITY, PANEL_PRIORITY

ASKED = """
import json, os, threading
from app.base.settings import Settings
from app.machine.process import {ask}

def seen():
    policy = os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
    return policy, os.sched_getparam(0).sched_priority

{ask}(Settings(real_time={real_time}))
found = {{"loop": seen()}}
thread = threading.Thread(target=lambda: found.update(thread=seen()))
thread.start()
thread.join()
reading, writing = os.pipe()
if os.fork() == 0:
    os.write(writing, json.dumps(seen()).encode())
    os._exit(0)
os.wait()
found["child"] = json.loads(os.read(reading, 99))
print(json.dumps(found))
"""
FIFO, ROUND_ROBIN = (os.SCHED_FIFO, FIFO_PRIORITY), (os.SCHED_RR, PANEL_PRIORITY)
ORDINARY = (os.SCHED_OTHER, 0)


@pytest.mark.parametrize(
    ("ask", "loop", "others"),
    [("raise_priority", FIFO, FIFO), ("raise_priority_of_panel", ROUND_ROBIN, ORDINARY)],
)
def test_the_controller_is_in_real_time_and_of_the_panel_its_loop_alone(
    ask: str, loop: tuple[int, int], others: tuple[int, int]
) -> None:
    """Where the system does not allow it all goes on as it was."""
    allowed = os.geteuid() == 0 or resource.getrlimit(resource.RLIMIT_RTPRIO)[0] >= FIFO_PRIORITY
    wanted = {"loop": loop, "thread": others, "child": others} if allowed else dict.fromkeys(
        ("loop", "thread", "child"), ORDINARY
    )  # fmt: skip
    assert _seen(ask) == wanted


def test_where_it_is_switched_off_all_goes_on_as_it_was() -> None:
    imports = "from app.base.settings import Settings\nfrom app.machine.process import raise_priority\n"
    first = f"{imports}raise_priority(Settings(real_time=False))\n"
    assert set(_seen("raise_priority_of_panel", first, real_time=False).values()) == {_as_it_was()}


def test_without_permission_it_goes_on() -> None:
    refused = "import resource; resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))\n"
    if os.geteuid() == 0:
        refused += "import os; os.setuid(65534)\n"
    assert set(_seen("raise_priority_of_panel", refused).values()) == {_as_it_was()}


def _as_it_was() -> tuple[int, int]:
    return os.sched_getscheduler(0), os.sched_getparam(0).sched_priority


def _seen(ask: str, first: str = "", *, real_time: bool = True) -> dict[str, tuple[int, int]]:
    """Return policy and priority of a process that asked, of its thread and of its child."""
    asked = ASKED.format(ask=ask, real_time=real_time)
    script = "import app.machine.process\n" + first + asked
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return {name: tuple(seen) for name, seen in json.loads(told.stdout.splitlines()[-1]).items()}
