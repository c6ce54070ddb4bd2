"""Where the panel is found on the network: what the page Network has set, in a file of the data folder."""

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from app.base.file_text import toml_of

FILE_NAME = "network.toml"
PRIVATE = 0o600


@dataclass(frozen=True, slots=True)
class Network:
    """Address and port to listen on, other names of the panel, proxies that are believed, https or not."""

    host: str
    port: int
    allowed_hosts: tuple[str, ...]
    trusted_proxies: tuple[str, ...]
    tls: bool


NETWORK_FIELDS = tuple(Network.__dataclass_fields__)


def read_network(folder: Path) -> dict[str, Any]:
    """Return what the page has set, by the names of the settings; nothing where it never did.

    Raises `OSError` or `ValueError` for a file that cannot be read.
    """
    path = folder / FILE_NAME
    return toml_of(path.read_bytes()) if path.exists() else {}


def write_network(folder: Path, network: Network) -> None:
    """Keep what is set; the file is there whole or not at all, after a power cut too."""
    path = folder / FILE_NAME
    unfinished = path.with_name(f"{FILE_NAME}.unfinished")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    lines = [f"{name} = {json.dumps(value)}\n" for name, value in asdict(network).items()]
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, PRIVATE)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(
            "# Written by the page Network; without this file the environment and the defaults count.\n"
        )
        file.writelines(lines)
        file.flush()
        os.fsync(file.fileno())
    unfinished.replace(path)
    folder_descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(folder_descriptor)
    finally:
        os.close(folder_descriptor)
