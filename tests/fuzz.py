"""`python -m tests.fuzz`: at least 10,000 cases against the whole API, then hostile values for every form.

The panel is the real one on a machine in memory. It ends with exit code 1 at the first kind of failure.
"""

import asyncio
import socket
import subprocess
import sys
import threading
from datetime import timedelta
from pathlib import Path

import uvicorn

from app.clock import SystemClock
from tests.fakes import fake_app
from tests.web.test_forms import fuzz

EXAMPLES = 110
FORM_ROUNDS = 60
SEED = 3
SCHEMATHESIS = Path(sys.executable).with_name("st")
LEFT_OUT = "stream|backup|simulations|accuracy|papers|session|users|tokens|me/"
"""Streams do not end; the others are expensive, or would sign the fuzzer out."""

NOT_CHECKED = "unsupported_method,positive_data_acceptance,missing_required_header,ignored_auth"
"""Starlette's answers to unknown methods; rules between fields that no schema can tell; and who may do what,
which `tests/web/test_gate.py` holds for every route."""


async def _serving(port: int, ready: threading.Event) -> None:
    server = uvicorn.Server(uvicorn.Config(fake_app(), port=port, log_level="error"))
    task = asyncio.create_task(server.serve())
    clock = SystemClock()
    while not server.started:
        await clock.sleep_until(clock.now() + timedelta(milliseconds=50))
    ready.set()
    await task


def main() -> int:
    """Run both fuzzers and return the exit code."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    ready = threading.Event()
    threading.Thread(target=lambda: asyncio.run(_serving(port, ready)), daemon=True).start()
    ready.wait(30)
    print(f"{asyncio.run(fuzz(FORM_ROUNDS, SEED))} bad values were sent to the forms; none broke anything.")
    url = f"http://127.0.0.1:{port}/api/v1/openapi.json"
    command = [
        str(SCHEMATHESIS), "run", url, "-n", str(EXAMPLES), "-w", "2", "--seed", str(SEED),
        "--suppress-health-check", "all", "--exclude-path-regex", LEFT_OUT,
        "--exclude-checks", NOT_CHECKED, "--continue-on-failure", "--phases", "examples,fuzzing,stateful",
    ]  # fmt: skip
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
