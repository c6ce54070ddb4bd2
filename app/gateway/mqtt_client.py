"""The connection to a broker, with the reasons that it gives: why it refused something, why it ended."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import paho.mqtt.client as paho
from aiomqtt import Client, MqttError, ProtocolVersion, TLSParameters, Will
from paho.mqtt.properties import Properties
from paho.mqtt.reasoncodes import ReasonCode

from app.base.clock import Clock
from app.base.settings import Settings
from app.gateway.mqtt_messages import OFFLINE

AT_LEAST_ONCE = 1
ANSWER_WITHIN_S = 5.0
KEEPALIVE_S = 15
SAY_AGAIN = timedelta(minutes=1)
MOST_COMMANDS_WAITING = 100
LONGEST_REFERENCE = 120
FEWEST_AT_ONCE = 10
"""So many unacknowledged messages every common broker takes; the library does not ask how many it takes."""


@dataclass(frozen=True, slots=True)
class Reason:
    """A reason code of MQTT 5, and the server that the broker refers to instead of itself, if it does."""

    code: int
    server: str = ""


class Refused(MqttError):
    """The broker did not take a message."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(f"refused with code {reason.code}")
        self.reason = reason


class BrokerClient(Client):
    """The library's client, which drops what a broker says at PUBACK, and mixes up who ended a connection."""

    def __init__(self, hostname: str, port: int, **options: Any) -> None:
        super().__init__(hostname, port, max_inflight_messages=FEWEST_AT_ONCE, **options)
        self.reason: Reason | None = None
        """Why the broker refused or ended this connection; None while it is up, or if it did not say."""
        self.was_accepted = False
        self._refusals: dict[int, Reason] = {}

    def close(self) -> None:
        """Close what is left: the library keeps a connection open that the broker was too slow to accept."""
        self._client._sock_close()  # noqa: SLF001 - the library has no other way
        if self._disconnected.done() and not self._disconnected.cancelled():
            self._disconnected.exception()

    def _on_connect(
        self,
        client: paho.Client,
        userdata: Any,
        flags: paho.ConnectFlags,
        reason_code: ReasonCode,
        properties: Properties | None = None,
    ) -> None:
        self.was_accepted = not reason_code.is_failure
        if reason_code.is_failure:
            self.reason = _reason(reason_code, properties)
        super()._on_connect(client, userdata, flags, reason_code, properties)

    def _on_disconnect(
        self,
        client: paho.Client,
        userdata: Any,
        flags: paho.DisconnectFlags,
        reason_code: ReasonCode,
        properties: Properties | None = None,
    ) -> None:
        if flags.is_disconnect_packet_from_server:
            self.reason = _reason(reason_code, properties)
        super()._on_disconnect(client, userdata, flags, reason_code, properties)

    def _on_publish(
        self,
        client: paho.Client,
        userdata: Any,
        mid: int,
        reason_code: ReasonCode,
        properties: Properties,
    ) -> None:
        if reason_code.is_failure:
            self._refusals[mid] = _reason(reason_code, properties)
        super()._on_publish(client, userdata, mid, reason_code, properties)

    @contextmanager
    def _pending_call(self, mid: int, value: Any, pending_dict: dict[int, Any]) -> Iterator[None]:
        with super()._pending_call(mid, value, pending_dict):
            yield
        refusal = self._refusals.pop(mid, None)
        if refusal is not None:
            raise Refused(refusal)


def _reason(code: ReasonCode, properties: Properties | None) -> Reason:
    server = str(getattr(properties, "ServerReference", ""))
    return Reason(code.value, server[:LONGEST_REFERENCE])


def broker_port(settings: Settings) -> int:
    """Return the port of the broker."""
    return settings.mqtt_port or (8883 if settings.mqtt_tls else 1883)


def broker_client(
    settings: Settings, clock: Clock, availability: str, protocol: ProtocolVersion
) -> BrokerClient:
    """Return a client that is still to be connected; its last will says at `availability` it is offline."""
    password = settings.mqtt_password
    return BrokerClient(
        settings.mqtt_host or "",
        broker_port(settings),
        username=settings.mqtt_username,
        password=None if password is None else password.get_secret_value(),
        identifier=settings.mqtt_client_id,
        will=Will(availability, OFFLINE, AT_LEAST_ONCE, retain=True),
        tls_params=_tls(settings) if settings.mqtt_tls else None,
        timeout=ANSWER_WITHIN_S,
        keepalive=KEEPALIVE_S,
        max_queued_incoming_messages=MOST_COMMANDS_WAITING,
        logger=quiet_logger(clock),
        protocol=protocol,
    )


def quiet_logger(clock: Clock) -> logging.Logger:
    """Return the library's logger, which says the same once a minute: it warns of every message of a flood.

    Each warning is written before the next tick; a flood of them on a busy disk held up stops for 0.4 s.
    """
    said: dict[str, datetime] = {}

    def is_news(record: logging.LogRecord) -> bool:
        now, last = clock.now(), said.get(record.msg)
        if last is not None and now - last < SAY_AGAIN:
            return False
        said[record.msg] = now
        return True

    logger = logging.Logger("mqtt")
    logger.parent = logging.getLogger()
    logger.addFilter(is_news)
    return logger


def _tls(settings: Settings) -> TLSParameters:
    return TLSParameters(
        ca_certs=_path(settings.mqtt_ca_file),
        certfile=_path(settings.mqtt_cert_file),
        keyfile=_path(settings.mqtt_key_file),
    )


def _path(file: Path | None) -> str | None:
    return None if file is None else str(file)
