"""`python -m tools.fuzz`: at least 10,000 cases against the whole API, and hostile values for every form.

Each text that the API takes is given texts of the world as well, and tables as files have them.

The panel is the real one on a machine in memory that keeps its two trackers and its recordings. Parts run
alone with `forms`, with `texts`, or with `api` and `--only REGEX` of paths, `--without REGEX` of others; the
exit code is 1 after any failure. It runs in a network of its own where that is allowed: the document's
examples name hosts, and what is fuzzed may call them.
"""

import argparse
import asyncio
import socket
import subprocess
import sys
import threading
from datetime import timedelta
from pathlib import Path

import uvicorn

from app.base.clock import SystemClock
from app.link.messages import DeleteRecording, Order, RemoveTracker
from app.store.migrations import upgrade
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.reason import Reason
from tests.fakes import FakeMachine, fake_app, serving
from tests.web.api_texts import send_texts
from tests.web.test_forms import fuzz
from tools.alone import begin_alone

EXAMPLES = 125
FORM_ROUNDS = 60
TEXTS_EACH = 10
SEED = 3
SCHEMATHESIS = Path(sys.executable).with_name("st")
CONFIG = Path(__file__).with_name("schemathesis.toml")
ACCOUNTS = "session|users|tokens|/me/"
"""They sign the fuzzer out, so they have a panel of their own."""
LEFT_OUT = f"/stream$|backup|simulations|accuracy|papers|{ACCOUNTS}"
"""A stream does not end, and the others calculate or copy for seconds: `texts` sends them fewer cases."""

NOT_CHECKED = "unsupported_method,positive_data_acceptance,missing_required_header,ignored_auth"
"""Starlette's answers to unknown methods; rules between fields that no schema can tell; and who may do what,
which `tests/web/test_gate_table.py` holds for every route."""


class LastingMachine(FakeMachine):
    """A machine that refuses to give up the trackers and recordings that it begins with."""

    def __init__(self) -> None:
        super().__init__()
        self._kept = {*self.trackers, *self.store.heads}

    async def execute(self, order: Order) -> SiteSnapshot:
        """Carry out one order, unless it removes what is kept."""
        match order.command:
            case RemoveTracker(tracker_id=name) | DeleteRecording(recording_id=name) if name in self._kept:
                raise CommandRejected(Reason("kept", f"{name} is kept for the next case.", "Take another."))
        return await super().execute(order)


async def _serving(port: int, ready: threading.Event) -> None:
    app = fake_app(LastingMachine())
    upgrade(app.state.panel.settings.url)
    server = uvicorn.Server(uvicorn.Config(app, port=port, log_level="error"))
    task = asyncio.create_task(server.serve())
    clock = SystemClock()
    while not server.started:
        await clock.sleep_until(clock.now() + timedelta(milliseconds=50))
    ready.set()
    await task


def _begin() -> str:
    """Serve the panel beside this and return where its document is."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    ready = threading.Event()
    threading.Thread(target=lambda: asyncio.run(_serving(port, ready)), daemon=True).start()
    ready.wait(30)
    return f"http://127.0.0.1:{port}/api/v1/openapi.json"


def _api(only: str, without: str, examples: int) -> int:
    command = [
        str(SCHEMATHESIS), "--config-file", str(CONFIG), "run", _begin(), "-n", str(examples), "-w", "2",
        "--seed", str(SEED), "--suppress-health-check", "all", "--include-path-regex", only,
        "--exclude-path-regex", without, "--exclude-checks", NOT_CHECKED, "--continue-on-failure",
        "--phases", "examples,fuzzing,stateful", "--generation-database", "none", "--warnings", "off",
        "--request-timeout", "60",
    ]  # fmt: skip
    return subprocess.run(command, check=False).returncode


def _forms() -> None:
    print(f"{asyncio.run(fuzz(FORM_ROUNDS, SEED))} bad values were sent to the forms; none broke anything.")


async def _texts() -> int:
    app = fake_app(LastingMachine())
    async with serving(app) as client:
        return await send_texts(client, app.openapi(), TEXTS_EACH, SEED)


def main() -> int:
    """Run what was asked for, without a name both, and return the exit code."""
    arguments = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
    arguments.add_argument("part", nargs="?", choices=("api", "forms", "texts", "all"), default="all")
    arguments.add_argument("--only", help="regular expression of the API's paths")
    arguments.add_argument("--without", default=LEFT_OUT, help="regular expression of paths left out")
    arguments.add_argument("--examples", type=int, default=EXAMPLES, help="cases for each operation")
    given = arguments.parse_args()
    begin_alone("tools.fuzz", *sys.argv[1:])
    if given.part in ("forms", "all"):
        _forms()
    if given.part in ("texts", "all"):
        print(f"{asyncio.run(_texts())} texts were sent to the API; none broke anything.")
    if given.part not in ("api", "all"):
        return 0
    if given.only is not None:
        return _api(given.only, given.without, given.examples)
    return _api(".", given.without, given.examples) or _api(ACCOUNTS, "^$", given.examples)


if __name__ == "__main__":
    sys.exit(main())
