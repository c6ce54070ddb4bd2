"""The environment as one frozen object, read once by the mains and the command line."""

import hashlib
import tempfile
from pathlib import Path
from typing import Literal

from pydantic import Field, field_validator
from pydantic_settings import (
    BaseSettings,
    SettingsConfigDict,
)

LONGEST_SOCKET_PATH = 100
LOOPBACK = {"127.0.0.1", "::1", "localhost"}


class Settings(BaseSettings):
    """`HELIOPANEL_*` variables, or the same names in the file that `HELIOPANEL_CONFIG` names (TOML)."""

    model_config = SettingsConfigDict(env_prefix="HELIOPANEL_", frozen=True, extra="forbid")

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

    @field_validator("host")
    @classmethod
    def _loopback_only(cls, host: str) -> str:
        if host not in LOOPBACK:
            raise ValueError(
                f"Heliopanel does not listen on {host}: until access control is built, only loopback is "
                "allowed (127.0.0.1 or ::1). Leave HELIOPANEL_HOST unset, or use an SSH tunnel to this computer."
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
