"""What a container runs and what compose.yaml puts beside it; no engine is needed here."""

import os
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from aiomqtt import Client, MqttError

from app.base.settings import Settings, read_settings
from tests.e2e.product import COMMAND
from tests.gateway.test_mqtt import Broker

DEPLOY = Path(__file__).resolve().parents[2] / "deploy"
COMPOSE: dict[str, Any] = yaml.safe_load((DEPLOY / "compose.yaml").read_text())
SECRET_SETTINGS = {"database_url", "mqtt_password"}


def secrets(folder: Path, *more: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, DEPLOY / "make_secrets.py", folder, *more]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_every_service_is_hardened_and_none_is_open_to_the_network() -> None:
    for service in COMPOSE["services"].values():
        assert service["read_only"] is True
        assert service["security_opt"] == ["no-new-privileges:true"]
        assert all(port.startswith("127.0.0.1:") for port in service.get("ports", ()))
        for variable, value in service.get("environment", {}).items():
            assert variable.removeprefix("HELIOPANEL_").lower() not in SECRET_SETTINGS
            assert "PASSWORD" not in variable or value.startswith("/run/secrets/")


def test_the_secrets_are_made_at_random_and_only_once(tmp_path: Path) -> None:
    folders = tmp_path / "one", tmp_path / "other"
    for folder in folders:
        assert secrets(folder).returncode == 0
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    wanted = {Path(secret["file"]).name for secret in COMPOSE["secrets"].values()}
    one, other = ({path.name: path.read_text() for path in folder.iterdir()} for folder in folders)
    assert set(one) == set(other) == wanted
    assert all(one[name] != other[name] for name in wanted)
    assert f":{one['database_password']}@database/" in one["settings.toml"]
    again = secrets(folders[0])
    assert again.returncode == 1
    assert "is not empty" in again.stderr
    assert {path.name: path.read_text() for path in folders[0].iterdir()} == one


def test_heliopanel_takes_the_settings_that_were_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secrets(tmp_path / "secrets")
    environment = COMPOSE["services"]["heliopanel"]["environment"] | {
        "HELIOPANEL_CONFIG": str(tmp_path / "secrets/settings.toml"),
        "HELIOPANEL_ALLOWED_HOSTS": "",
    }
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    found = read_settings()
    assert found.url.startswith("postgresql+psycopg://heliopanel:")
    assert found.mqtt_password is not None
    assert len(found.mqtt_password.get_secret_value()) == 32
    named = {name.removeprefix("HELIOPANEL_").lower() for name in environment} - {"config"}
    assert named <= set(Settings.model_fields)


async def knocks(port: int, user: str | None, password: str | None) -> bool:
    try:
        async with Client("127.0.0.1", port, username=user, password=password):
            return True
    except MqttError:
        return False


async def test_a_real_broker_lets_in_who_has_a_password_and_nobody_else(tmp_path: Path) -> None:
    folder = tmp_path / "secrets"
    secrets(folder)
    added = secrets(folder, "--broker-user", "home").stdout.split()
    home = added[added.index("is") + 1].removesuffix(".")
    ours = (folder / "settings.toml").read_text().split('mqtt_password = "')[1].split('"')[0]
    lines = (DEPLOY / "mosquitto.conf").read_text().replace("/run/secrets", str(folder))
    kept = [line for line in lines.splitlines() if not line.startswith(("#", "listener", "persistence"))]
    broker = Broker(tmp_path, lines=(*kept, "user root"))
    await broker.start()
    try:
        assert await knocks(broker.port, "heliopanel", ours)
        assert await knocks(broker.port, "home", home)
        assert not await knocks(broker.port, "heliopanel", home)
        assert not await knocks(broker.port, None, None)
    finally:
        await broker.kill()


def test_a_container_makes_its_certificate_once_and_then_serves(tmp_path: Path) -> None:
    tools, data = tmp_path / "bin", tmp_path / "data"
    tools.mkdir()
    stand_in = tools / "heliopanel"
    stand_in.write_text(
        '#!/bin/sh\n[ "$1" != serve ] || { echo "serves on $HELIOPANEL_HOST $2"; exit; }\n'
        f'exec {COMMAND} "$@"\n'
    )
    stand_in.chmod(0o755)
    environment = {
        "PATH": f"{tools}:{os.environ['PATH']}",
        "HELIOPANEL_DATA_DIR": str(data),
        "HELIOPANEL_HOST": "0.0.0.0",
        "HELIOPANEL_ALLOWED_HOSTS": "panel.example",
    }
    told = [
        subprocess.run(
            [DEPLOY / "container-start", "--port=1"],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for _ in range(2)
    ]
    assert "panel.example" in told[0]
    assert told[0].endswith("serves on 0.0.0.0 --port=1\n")
    assert told[1] == "serves on 0.0.0.0 --port=1\n"
    assert stat.S_IMODE((data / "tls/server.key").stat().st_mode) == 0o600
