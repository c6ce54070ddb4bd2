"""Whether the panel could be served as somebody wants it: said before anything is tried."""

import ipaddress
import re
import socket
import ssl
from collections.abc import Iterable
from dataclasses import asdict
from datetime import datetime

from pydantic import ValidationError

from app.base.addresses.own_names import own_names
from app.base.message import N_, Message, join, say, told_by, told_of_value
from app.base.network import Network
from app.base.settings import LOOPBACK, PREFIX, Settings
from app.base.startup import late

NAME = re.compile(r"(?!-)[A-Za-z0-9-]{1,63}(?<!-)(\.(?!-)[A-Za-z0-9-]{1,63}(?<!-))*\.?")
MOST_NAMES = 20
LONGEST_NAME = 253


class NetworkRefused(Exception):
    """The panel cannot be served so; `errors` has a sentence for every field that is wrong."""

    def __init__(self, errors: dict[str, Message]) -> None:
        self.errors = errors
        super().__init__(join(" ", errors.values()))


def refuse_impossible(
    now_served: Settings, wanted: Network, fixed: Iterable[str], *, has_administrator: bool
) -> None:
    """Raise `NetworkRefused` with everything that is wrong; nothing is written."""
    errors = _fixed(now_served.network, wanted, fixed) | _misspelt(wanted)
    if "host" not in errors and (refusal := _cannot_listen(now_served.network, wanted)):
        field, sentence = refusal
        errors.setdefault(field, sentence)
    if wanted.host not in LOOPBACK and not has_administrator:
        errors.setdefault(
            "host",
            N_(
                "Other devices could reach Heliopanel, which has no users yet. Add an administrator "
                "on the Users page first."
            ),
        )
    if errors:
        raise NetworkRefused(errors)


def prepared(now_served: Settings, wanted: Network, now: datetime) -> Settings:
    """Return the settings with what is wanted, a certificate made where one is missing, or refuse them."""
    if wanted.tls:
        _certify(now_served, wanted, now)
    settings = _settings(now_served, wanted)
    if settings.certificate is not None:
        _load(settings)
    return settings


def addresses_here() -> tuple[str, ...]:
    """Return the addresses of this computer that others may reach."""
    return tuple(
        name for name in own_names() if _is_address(name) and not ipaddress.ip_address(name).is_loopback
    )


def _fixed(now_served: Network, wanted: Network, fixed: Iterable[str]) -> dict[str, Message]:
    return {
        name: (
            say(
                "This value is set by {prefix}{upper} at the start of the service; change the "
                "variable there.",
                prefix=PREFIX,
                upper=name.upper(),
            )
        )
        for name in fixed
        if getattr(now_served, name) != getattr(wanted, name)
    }


def _misspelt(wanted: Network) -> dict[str, Message]:
    errors: dict[str, Message] = {}
    if wanted.host != "localhost" and not _is_address(wanted.host):
        errors["host"] = say(
            "{value} is not an IP address. Enter 127.0.0.1, 0.0.0.0, or an address of the "
            "controller's computer.",
            value=wanted.host[:60] or N_("Nothing"),
        )
    wrong = [name for name in wanted.allowed_hosts if len(name) > LONGEST_NAME or not NAME.fullmatch(name)]
    if wrong:
        errors["allowed_hosts"] = say(
            "{wrong} is not a host name. Enter names such as tracker.example.", wrong=wrong[0][:60]
        )
    for field in ("allowed_hosts", "trusted_proxies"):
        if len(getattr(wanted, field)) > MOST_NAMES:
            errors[field] = say("Enter at most {most_names} names.", most_names=MOST_NAMES)
    return errors


def _cannot_listen(now_served: Network, wanted: Network) -> tuple[str, Message] | None:
    """Return which field is wrong and why; the port that this panel holds itself is not tried."""
    if fault := _fault_of(wanted.host, 0):
        return (
            "host",
            (
                say(
                    "The controller's computer cannot listen on {host}: {fault}. Enter one of its own "
                    "addresses.",
                    host=wanted.host,
                    fault=fault,
                )
            ),
        )
    if wanted.port != now_served.port and (fault := _fault_of(wanted.host, wanted.port)):
        return "port", say(
            "Port {port} cannot be used: {fault}. Choose another one, such as 8443.",
            port=wanted.port,
            fault=fault,
        )
    return None


def _fault_of(host: str, port: int) -> str:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        with socket.socket(family) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
    except OSError as error:
        return (error.strerror or str(error)).lower()
    return ""


def _certify(now_served: Settings, wanted: Network, now: datetime) -> None:
    """Make a certificate of our own that is for every name wanted, unless one was given or there is one."""
    if now_served.tls_cert_file is not None:
        return
    host = (
        ()
        if wanted.host == "localhost" or ipaddress.ip_address(wanted.host).is_unspecified
        else (wanted.host,)
    )
    needed = (*own_names(), *wanted.allowed_hosts, *host)
    certificates = late("app.base.certificates")
    path = now_served.tls_dir / certificates.SERVER
    have = certificates.read(path).names if path.is_file() else ()
    if not set(needed) <= set(have):
        certificates.init(now_served.tls_dir, (*needed, *have), now)


def _settings(now_served: Settings, wanted: Network) -> Settings:
    given = {name: getattr(now_served, name) for name in type(now_served).model_fields}
    try:
        return Settings(**given | asdict(wanted))
    except ValidationError as error:
        raise NetworkRefused(
            {str(one["loc"][0]) if one["loc"] else "tls": told_of_value(one) for one in error.errors()}
        ) from error


def _load(settings: Settings) -> None:
    """Raise `NetworkRefused` if the certificate and its key cannot be served."""
    certificate, key = settings.certificate or ("", "")
    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(certificate, key)
    except OSError as error:
        raise NetworkRefused(
            {
                "tls": say(
                    "The certificate {certificate} cannot be used: {error}. Name another certificate, or "
                    "turn HTTPS off.",
                    certificate=certificate,
                    error=told_by(error),
                )
            }
        ) from error


def _is_address(text: str) -> bool:
    try:
        ipaddress.ip_address(text)
    except ValueError:
        return False
    return True
