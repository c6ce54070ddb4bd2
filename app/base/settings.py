"""The environment as one frozen object, read once by the mains and the command line."""

import ipaddress
import os
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, SecretStr, ValidationError, ValidationInfo, field_validator, model_validator
from pydantic_settings import (
    BaseSettings,
    InitSettingsSource,
    NoDecode,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
)

from app.base.addresses.socket_path import socket_path
from app.base.addresses.sqlite_url import sqlite_url
from app.base.addresses.topics import checked_name, checked_topic
from app.base.errors import WRONG, Foreseen
from app.base.file_text import toml_of
from app.base.hosts import checked_host
from app.base.network import FILE_NAME, NETWORK_FIELDS, Network, read_network

PREFIX = "HELIOPANEL_"
FILE_VARIABLE = "HELIOPANEL_CONFIG"

LOOPBACK = {"127.0.0.1", "::1", "localhost"}


class SettingsWrong(Foreseen):
    """Heliopanel cannot start with these settings; the text says which one and why."""

    exit_code = WRONG


class Settings(BaseSettings):
    """`HELIOPANEL_*` variables, or the same names in the file that `HELIOPANEL_CONFIG` names (TOML)."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="forbid")

    host: str = Field(
        "127.0.0.1", description="Address the panel listens on; beyond loopback only with a certificate."
    )
    allowed_hosts: Annotated[tuple[str, ...], NoDecode] = Field(
        (), description="Other names by which the panel is opened, separated by commas."
    )
    trusted_proxies: Annotated[tuple[str, ...], NoDecode] = Field(
        (),
        description="Addresses or networks of reverse proxies whose word on who asks is taken, separated by "
        "commas.",
    )
    tls_cert_file: Path | None = Field(
        None, description="Certificate (with chain) of the panel instead of what `heliopanel tls init` made."
    )
    tls_key_file: Path | None = Field(None, description="Its key.")
    tls: bool | None = Field(
        None, description="Serve https, or not although there is a certificate; unset: where there is one."
    )
    insecure_lan: bool = Field(
        False, description="Listen beyond loopback without a certificate; every page warns of it."
    )
    mdns: bool = Field(False, description="Announce the panel as heliopanel.local (needs the extra mdns).")
    login_banner: str = Field(
        "",
        max_length=1000,
        description="What stands above the form to sign in, for example who may use this system and that it "
        "is recorded.",
    )
    port: int = Field(8000, ge=1, le=65535, description="TCP port of the panel.")
    data_dir: Path = Field(
        Path("data"), description="Folder of the database, the lock, the link and backups."
    )
    database_url: str | None = Field(
        None, description="SQLAlchemy URL; default is heliopanel.db in the data folder."
    )
    log_format: Literal["json", "text"] = Field(
        "text", description="Structured log as JSON lines or as readable text."
    )
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "info", description="Least severe messages that the log has."
    )
    tick_ms: int = Field(100, ge=20, le=1000, description="Period of the control loop.")
    real_time: bool = Field(True, description="Ask the system for real-time scheduling, where it is allowed.")
    telemetry_retention_days: int = Field(
        400,
        ge=1,
        description="Recorded days older than this are removed; age counts while the controller runs.",
    )
    journal_retention_days: int = Field(
        1825,
        ge=30,
        description="Journal entries and ended alarms older than this are removed; age counts while the "
        "controller runs.",
    )
    memory_limit_mb: int = Field(
        500,
        ge=100,
        description="Memory of the controller service; an alarm comes at 3/4 of it, and at its limit it "
        "starts again as soon as every tracker is at standstill.",
    )
    recordings_max: int = Field(
        500, ge=1, description="Shows and simulations beyond this number are removed, oldest first."
    )
    sample_store_s: int = Field(
        300,
        ge=1,
        le=900,
        description="Seconds between two times that recorded samples are written to the disk; a power cut "
        "loses at most so many.",
    )
    weather_max_age_s: int = Field(
        300, ge=5, le=86400, description="A weather report older than this is shown as stale and not used."
    )
    sunspec_port: int | None = Field(
        None, ge=0, le=65535, description="TCP port of the SunSpec server; off unless set."
    )
    sunspec_host: str = Field(
        "127.0.0.1", description="Address the SunSpec server listens on; loopback only."
    )
    sunspec_unit_id: int = Field(
        1, ge=1, le=247, description="Modbus unit id that the SunSpec servers answer."
    )
    sunspec_serial_port: str | None = Field(
        None, description="Serial device of a SunSpec server over Modbus RTU; off unless set."
    )
    sunspec_baud_rate: int = Field(19200, ge=1200, le=1_000_000, description="Its baud rate; 8 data bits.")
    sunspec_parity: Literal["none", "even", "odd"] = Field("even", description="Its parity.")
    sunspec_write_hosts: Annotated[tuple[str, ...], NoDecode] = Field(
        (),
        description="Addresses or networks that may write over SunSpec, separated by commas; `serial` is the "
        "serial line. None unless set.",
    )
    mqtt_host: str | None = Field(None, description="Host of the MQTT broker; off unless set.")
    mqtt_port: int | None = Field(
        None, ge=1, le=65535, description="Its port; default is 1883, with TLS 8883."
    )
    mqtt_base_topic: str = Field(
        "heliopanel",
        description="First levels of every topic; another one for every controller on a broker.",
    )
    mqtt_client_id: str = Field(
        "heliopanel", min_length=1, max_length=64, description="Client id, unique on the broker."
    )
    mqtt_username: str | None = Field(None, description="User at the broker.")
    mqtt_password: SecretStr | None = Field(None, description="Its password.")
    mqtt_tls: bool = Field(False, description="Speak TLS and check the broker's certificate.")
    mqtt_ca_file: Path | None = Field(None, description="Certificates to trust instead of the system's.")
    mqtt_cert_file: Path | None = Field(None, description="Own certificate, where the broker wants one.")
    mqtt_key_file: Path | None = Field(None, description="Key of the own certificate.")
    mqtt_publish_interval_s: float = Field(1.0, ge=0.1, le=3600, description="Seconds between two snapshots.")
    mqtt_payload: Literal["trackers", "columns"] = Field(
        "trackers", description="One message a tracker, or one message of columns for the whole site."
    )
    mqtt_discovery: bool = Field(False, description="Announce sensors to Home Assistant.")
    mqtt_commands: bool = Field(False, description="Take commands over MQTT.")

    webhook_secret: SecretStr | None = Field(
        None, description="Secret that signs every webhook message (HMAC-SHA256); unsigned unless set."
    )
    smtp_host: str | None = Field(None, description="Mail server for alarms; no mail unless set.")
    smtp_port: int | None = Field(
        None, ge=1, le=65535, description="Its port; default is 587, with `tls` 465, with `none` 25."
    )
    smtp_tls: Literal["starttls", "tls", "none"] = Field(
        "starttls", description="How the way to it is encrypted."
    )
    smtp_username: str | None = Field(None, description="User at the mail server.")
    smtp_password: SecretStr | None = Field(None, description="Its password.")
    smtp_from: str = Field(
        "heliopanel@localhost", min_length=3, max_length=200, description="Sender of the mail."
    )

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Return where settings come from: arguments, the environment, the page Network, the file."""
        given = _from_file()
        places = (init_settings(), env_settings(), given)
        named = [found["data_dir"] for found in places if "data_dir" in found]
        network = _from_page(Path(named[0] if named else cls.model_fields["data_dir"].default))
        return (
            init_settings,
            env_settings,
            InitSettingsSource(settings_cls, network),
            InitSettingsSource(settings_cls, given),
        )

    @field_validator("mqtt_host", "smtp_host")
    @classmethod
    def _host(cls, host: str | None) -> str | None:
        return None if host is None else checked_host(host)

    @field_validator("mqtt_base_topic", "mqtt_client_id", "mqtt_username")
    @classmethod
    def _mqtt_text(cls, text: str | None, info: ValidationInfo) -> str | None:
        check = checked_topic if info.field_name == "mqtt_base_topic" else checked_name
        return None if text is None else check(PREFIX + str(info.field_name).upper(), text)

    @field_validator("sunspec_host")
    @classmethod
    def _loopback_only(cls, host: str, info: ValidationInfo) -> str:
        if host not in LOOPBACK:
            variable = PREFIX + str(info.field_name).upper()
            raise ValueError(
                f"Heliopanel does not serve SunSpec on {host}: Modbus knows no passwords, so only loopback "
                f"is allowed (127.0.0.1 or ::1). Leave {variable} unset, or use an SSH tunnel to this "
                "computer."
            )
        return host

    @field_validator("allowed_hosts", "trusted_proxies", mode="before")
    @classmethod
    def _listed(cls, given: object) -> object:
        return tuple(_words(given)) if isinstance(given, str) else given

    @field_validator("trusted_proxies")
    @classmethod
    def _proxies(cls, given: tuple[str, ...]) -> tuple[str, ...]:
        for host in given:
            _check_network(
                host, "HELIOPANEL_TRUSTED_PROXIES", "Write addresses or networks such as 10.0.0.5."
            )
        return given

    @model_validator(mode="after")
    def _listening(self) -> Self:
        if (self.tls_cert_file is None) != (self.tls_key_file is None):
            raise ValueError("HELIOPANEL_TLS_CERT_FILE and HELIOPANEL_TLS_KEY_FILE go together: set both.")
        if self.tls and self.certificate is None:
            raise ValueError(
                "HELIOPANEL_TLS is on, but there is no certificate. Make one with: heliopanel tls init"
            )
        refusal = refusal_to_listen(
            self.host, has_certificate=self.certificate is not None, insecure_lan=self.insecure_lan
        )
        if refusal:
            raise ValueError(refusal)
        return self

    @field_validator("sunspec_write_hosts", mode="before")
    @classmethod
    def _hosts(cls, given: object) -> object:
        if not isinstance(given, str):
            return given
        hosts = tuple(_words(given))
        for host in hosts:
            if host != "serial":
                _check_network(host)
        return hosts

    @model_validator(mode="after")
    def _discovery_of_trackers(self) -> Self:
        if self.mqtt_discovery and self.mqtt_payload != "trackers":
            raise ValueError(
                "HELIOPANEL_MQTT_DISCOVERY needs HELIOPANEL_MQTT_PAYLOAD=trackers: Home Assistant reads "
                "one message a tracker."
            )
        return self

    @property
    def url(self) -> str:
        """Return the database URL that the store opens."""
        return self.database_url or sqlite_url(self.data_dir.resolve() / "heliopanel.db")

    @property
    def access_url(self) -> str:
        """Return the database of users: a file of its own, or beside everything else on PostgreSQL."""
        if self.database_url is not None and not self.database_url.startswith("sqlite"):
            return self.database_url
        return sqlite_url(self.data_dir.resolve() / "access.db")

    @property
    def tls_dir(self) -> Path:
        """Return the folder of the certificates that `heliopanel tls init` makes."""
        return self.data_dir.resolve() / "tls"

    @property
    def certificate(self) -> tuple[Path, Path] | None:
        """Return the files of the panel's certificate and key: given ones, its own, None without https."""
        if self.tls is False:
            return None
        if self.tls_cert_file is not None and self.tls_key_file is not None:
            return self.tls_cert_file, self.tls_key_file
        own = self.tls_dir / "server.crt", self.tls_dir / "server.key"
        return own if all(path.is_file() for path in own) else None

    @property
    def network(self) -> Network:
        """Return what of these settings the page Network changes."""
        hosts, proxies, tls = self.allowed_hosts, self.trusted_proxies, self.certificate is not None
        return Network(self.host, self.port, hosts, proxies, tls)

    @property
    def scheme(self) -> str:
        """Return how the panel is opened: https with a certificate, http without."""
        return "http" if self.certificate is None else "https"

    @property
    def is_bare(self) -> bool:
        """Return whether a network reaches the panel without TLS, of which every page warns."""
        return not self.is_loopback and self.certificate is None

    @property
    def is_loopback(self) -> bool:
        """Return whether only this computer can reach the panel."""
        return self.host in LOOPBACK

    @property
    def link_path(self) -> Path:
        """Return the Unix socket between panel and machine."""
        return socket_path(self.data_dir.resolve() / "machine.sock")


def read_settings() -> Settings:
    """Return the settings of this process, or raise `SettingsWrong` with a sentence for every wrong one."""
    try:
        return Settings()
    except ValidationError as error:
        raise SettingsWrong(" ".join(_sentence(detail) for detail in error.errors())) from error


def fixed_by_environment() -> frozenset[str]:
    """Return what of the network the environment sets, so that the page Network cannot."""
    return frozenset(name for name in NETWORK_FIELDS if PREFIX + name.upper() in os.environ)


def refusal_to_listen(host: str, *, has_certificate: bool, insecure_lan: bool) -> str:
    """Return why the panel does not listen on an address, nothing if it does.

    Who may do what there is another question: without an administrator it serves only its set-up page.
    """
    if host in LOOPBACK or has_certificate or insecure_lan:
        return ""
    return (
        f"Heliopanel does not listen on {host} without a certificate: passwords would cross the network in "
        "the clear. Make one with `heliopanel tls init`, or name yours in HELIOPANEL_TLS_CERT_FILE and "
        "HELIOPANEL_TLS_KEY_FILE. On a network that nobody else can reach, --insecure-lan goes without."
    )


def _words(text: str) -> list[str]:
    return [word.strip() for word in text.split(",") if word.strip()]


def _check_network(
    host: str,
    variable: str = "HELIOPANEL_SUNSPEC_WRITE_HOSTS",
    hint: str = "Write addresses or networks such as 127.0.0.1 or 10.0.0.0/24, with commas, or serial.",
) -> None:
    try:
        ipaddress.ip_network(host, strict=False)
    except ValueError as error:
        raise ValueError(f"{variable} names {host!r}, which is no address. {hint}") from error


def _sentence(detail: Any) -> str:
    if detail["type"] == "value_error":
        return str(detail["ctx"]["error"])
    name = PREFIX + "_".join(str(part) for part in detail["loc"]).upper()
    return f"{name} is wrong: {detail['msg']}."


def _from_page(folder: Path) -> dict[str, Any]:
    """Return what the page Network has set."""
    try:
        return read_network(folder)
    except (OSError, ValueError) as error:
        raise SettingsWrong(
            f"The file {folder / FILE_NAME}, which the page Network wrote, cannot be read: {_reason(error)}. "
            "Remove it; the environment and the defaults count then."
        ) from error


def _reason(error: Exception) -> str:
    return str(error).rstrip(".")


def _from_file() -> dict[str, Any]:
    """Return what the file that `HELIOPANEL_CONFIG` names says, under the names of the fields."""
    path = os.environ.get(FILE_VARIABLE)
    if not path:
        return {}
    try:
        found = toml_of(Path(path).read_bytes())
    except (OSError, ValueError) as error:
        raise SettingsWrong(
            f"The settings file {path} of {FILE_VARIABLE} cannot be read: {_reason(error)}."
        ) from error
    return {name.removeprefix(PREFIX).lower(): value for name, value in found.items()}
