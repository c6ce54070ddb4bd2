"""`heliopanel status` and `heliopanel diagnostics`: how it is, for a person and for support."""

import asyncio
import json
import ssl
from contextlib import closing, suppress
from dataclasses import asdict, dataclass
from http.client import HTTPConnection, HTTPException, HTTPSConnection
from pathlib import Path
from typing import Annotated

import typer

from app.base.build import VERSION
from app.base.clock import SystemClock
from app.base.errors import AT_RUN_TIME, Foreseen
from app.base.settings import Settings
from app.cli.options import Config, DataDir, settle
from app.link.client import LinkClient
from app.link.messages import MachineUnreachable
from app.machine.lock import holder
from app.store.engine import open_reader
from app.store.files import private_opener
from app.tracker.state.snapshot import SiteSnapshot
from app.web.features.operations.diagnostics import Parts, about, live, stored, zipped

PATIENCE_S = 3.0
# Nothing is bound here: what listens everywhere is asked on the loopback.
EVERYWHERE = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # nosec B104


@dataclass(frozen=True, slots=True)
class Status:
    """What answers and what does not."""

    version: str
    data_dir: str
    controller_process: int | None
    controller_answers: bool
    panel: str
    web_version: str
    trackers: tuple[tuple[str, str, str], ...] = ()

    @property
    def is_well(self) -> bool:
        """Return whether both processes answer."""
        return self.controller_answers and bool(self.web_version)


def status(
    *,
    config: Config = None,
    data_dir: DataDir = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Say whether controller service and panel answer and what the trackers do; exit code 1 if not."""
    settings = settle(config, data_dir)
    found = _found(settings, asyncio.run(_site(settings)))
    typer.echo(json.dumps(asdict(found)) if as_json else "\n".join(_lines(found)))
    if not found.is_well:
        raise typer.Exit(AT_RUN_TIME)


def diagnostics(
    file: Annotated[Path, typer.Argument(help="File to write.")] = Path("heliopanel-diagnostics.zip"),
    *,
    config: Config = None,
    data_dir: DataDir = None,
) -> None:
    """Write versions, settings without secrets, state and journal into a zip file, whatever still answers."""
    settings = settle(config, data_dir)
    if file.exists():
        raise ValueError(f"{file} exists already. Name another file, or remove that one.")
    content = zipped(asyncio.run(_gathered(settings)))
    with open(file, "xb", opener=private_opener) as written:
        written.write(content)
    typer.echo(f"The diagnostics are in {file} ({len(content)} bytes). Passwords are not in it.")


async def _site(settings: Settings) -> SiteSnapshot | None:
    """Return what the machine tells, None if it does not answer."""
    async with LinkClient(settings.link_path) as machine:
        await _first_word(machine)
        return machine.latest()


async def _first_word(machine: LinkClient) -> None:
    """Wait until the machine has told something, or does not answer."""
    with suppress(TimeoutError):
        async with asyncio.timeout(PATIENCE_S):
            async for _ in machine.updates():
                return


async def _gathered(settings: Settings) -> Parts:
    """Return all parts that can be had, and why the others cannot."""
    parts, missing = about(settings, SystemClock().now()), {}
    try:
        with closing(open_reader(settings.url)) as reader:
            parts |= stored(reader)
    except Foreseen as failure:
        missing["journal"] = str(failure)
    async with LinkClient(settings.link_path) as machine:
        await _first_word(machine)
        try:
            parts |= await live(machine)
        except MachineUnreachable as failure:
            missing["controller"] = str(failure)
    return parts | ({"missing.json": missing} if missing else {})


def _found(settings: Settings, site: SiteSnapshot | None) -> Status:
    host = EVERYWHERE.get(settings.host, settings.host)
    shown = f"[{host}]" if ":" in host else host
    return Status(
        VERSION,
        str(settings.data_dir.resolve()),
        holder(settings.data_dir),
        site is not None,
        f"{settings.scheme}://{shown}:{settings.port}",
        _web_version(settings, host),
        tuple((one.tracker_id, one.name, one.activity.value) for one in site.trackers) if site else (),
    )


def _web_version(settings: Settings, host: str) -> str:
    """Return which version the panel on this computer says it is, empty if it does not answer."""
    if settings.certificate is None:
        asked = HTTPConnection(host, settings.port, timeout=PATIENCE_S)
    else:
        # Its certificate is for its names on the network; here it is asked by its address on this computer.
        # Nothing secret is sent or believed.
        trusting = ssl.create_default_context()
        trusting.check_hostname, trusting.verify_mode = False, ssl.CERT_NONE
        asked = HTTPSConnection(host, settings.port, timeout=PATIENCE_S, context=trusting)
    with closing(asked), suppress(OSError, HTTPException, ValueError):
        asked.request("GET", "/health")
        told = json.loads(asked.getresponse().read())
        return str(told.get("version", "")) if isinstance(told, dict) else ""
    return ""


def _lines(found: Status) -> list[str]:
    running = "" if found.controller_process is None else f" (process {found.controller_process})"
    panel = f"answers at {found.panel}" if found.web_version else f"does not answer at {found.panel}"
    other = "" if found.web_version in ("", found.version) else f", version {found.web_version}"
    return [
        f"Heliopanel {found.version}, data in {found.data_dir}",
        f"Controller service: {'answers' if found.controller_answers else 'does not answer'}{running}",
        f"Panel: {panel}{other}",
        *(f"{key} {name}: {doing.replace('_', ' ')}" for key, name, doing in found.trackers),
    ]
