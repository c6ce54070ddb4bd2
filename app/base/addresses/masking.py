"""Addresses without their secrets: who may not set a webhook sees where it leads, never what opens it."""

from typing import Any
from urllib.parse import urlsplit

HIDDEN = "***"
SECRET_NAMES = frozenset({"webhook_url"})


def masked(address: str) -> str:
    """Return an address with its host alone: user, password, path, query and fragment may be secrets."""
    try:
        parts = urlsplit(address)
        host, port = parts.hostname, parts.port
    except ValueError:
        return HIDDEN
    if not host:
        return HIDDEN if address else ""
    user = f"{HIDDEN}@" if "@" in parts.netloc else ""
    place = f"[{host}]" if ":" in host else host
    rest = f"/{HIDDEN}" if parts.path.strip("/") or parts.query or parts.fragment else parts.path
    return f"{parts.scheme}://{user}{place}{'' if port is None else f':{port}'}{rest}"


def without_secrets(value: Any) -> Any:
    """Return plain data, its names alone or as paths, with every address that may hold a secret masked."""
    if isinstance(value, dict):
        return {name: _hidden(name, one) for name, one in value.items()}
    return [without_secrets(one) for one in value] if isinstance(value, list | tuple) else value


def _hidden(name: object, value: Any) -> Any:
    is_secret = isinstance(value, str) and str(name).rpartition(".")[2] in SECRET_NAMES
    return masked(value) if is_secret else without_secrets(value)
