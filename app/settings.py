"""The environment as one frozen object, read once by the mains and the command line."""

import hashlib
import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, ValidationError, field_validator
from pydantic_settings import (
    BaseSettings,
    InitSettingsSource,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
)

PREFIX = "HELIOPANEL_"
FILE_VARIABLE = "HELIOPANEL_CONFIG"

LONGEST_SOCKET_PATH = 100
LOOPBACK = {"127.0.0.1", "::1", "localhost"}


class SettingsWrong(Exception):
    """Heliopanel cannot start with these settings; the text says which one and why."""


class Settings(BaseSettings):
    """`HELIOPANEL_*` variables, or the same names in the file that `HELIOPANEL_CONFIG` names (TOML)."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="forbid")

    host: str = Field(
        "127.0.0.1", description="Address the panel listens on; loopback only until access control exists."
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
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    tick_ms: int = Field(100, ge=20, le=1000, description="Period of the control loop.")
    telemetry_retention_days: int = Field(400, ge=1, description="Recorded days older than this are removed.")
    recordings_keep: int = Field(
        500, ge=1, description="Shows and simulations beyond this number are removed, oldest first."
    )
    weather_stale_s: int = Field(
        300, ge=5, le=86400, description="A weather report older than this is shown as stale and not used."
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
        """Return where settings come from: arguments before the environment before the file."""
        return init_settings, env_settings, InitSettingsSource(settings_cls, _from_file())

    @field_validator("host")
    @classmethod
    def _loopback_only(cls, host: str) -> str:
        if host not in LOOPBACK:
            raise ValueError(
                f"Heliopanel does not listen on {host}: until access control is built, only loopback is "
                "allowed (127.0.0.1 or ::1). Leave HELIOPANEL_HOST unset, or use an SSH tunnel to this "
                "computer."
            )
        return host

    @property
    def url(self) -> str:
        """Return the database URL that the store opens."""
        return self.database_url or f"sqlite:///{self.data_dir.resolve() / 'heliopanel.db'}"

    @property
    def link_path(self) -> Path:
        """Return the Unix socket between panel and machine; kept short, as the system limits its length."""
        path = self.data_dir.resolve() / "machine.sock"
        if len(str(path)) <= LONGEST_SOCKET_PATH:
            return path
        digest = hashlib.sha256(str(path).encode()).hexdigest()[:16]
        return Path(tempfile.gettempdir()) / f"heliopanel-{digest}.sock"


def read_settings() -> Settings:
    """Return the settings of this process, or raise `SettingsWrong` with a sentence for every wrong one."""
    try:
        return Settings()
    except ValidationError as error:
        raise SettingsWrong(" ".join(_sentence(detail) for detail in error.errors())) from error


def _sentence(detail: Any) -> str:
    if detail["type"] == "value_error":
        return str(detail["ctx"]["error"])
    name = PREFIX + "_".join(str(part) for part in detail["loc"]).upper()
    return f"{name} is wrong: {detail['msg']}."


def _from_file() -> dict[str, Any]:
    """Return what the file that `HELIOPANEL_CONFIG` names says, under the names of the fields."""
    path = os.environ.get(FILE_VARIABLE)
    if not path:
        return {}
    try:
        found = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise SettingsWrong(
            f"The settings file {path} of {FILE_VARIABLE} cannot be read: {error}."
        ) from error
    return {name.removeprefix(PREFIX).lower(): value for name, value in found.items()}
