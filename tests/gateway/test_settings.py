"""Every other door is shut until a setting opens it, and wrong settings are named in a sentence."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

from app.base.settings import Settings, SettingsWrong, read_settings
from app.gateway.gateways import Gateways, writes
from app.link.metrics import GatewayStatus
from tests.gateway.rigs import HurriedClock, kept_plant
from tests.patience import PATIENCE_S, pause


async def test_without_settings_every_door_is_shut_and_says_how_it_is_opened(tmp_path: Path) -> None:
    async with kept_plant(tmp_path) as (plant, store):
        gateways = Gateways(plant.site, HurriedClock(), read_settings(), store)
        gateways.start()
        told = (await gateways.metrics()).gateways
        await gateways.close()
    assert {one.status for one in told} == {GatewayStatus.OFF}
    assert [one.where.split()[1] for one in told] == [
        "HELIOPANEL_SUNSPEC_PORT",
        "HELIOPANEL_SUNSPEC_SERIAL_PORT",
        "HELIOPANEL_MQTT_HOST",
        "an",
        "an",
    ]


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("SUNSPEC_HOST", "0.0.0.0", "Leave HELIOPANEL_SUNSPEC_HOST unset"),
        ("SUNSPEC_WRITE_HOSTS", "10.0.0.0/24, plant", "names 'plant', which is no address"),
        ("SUNSPEC_UNIT_ID", "0", "HELIOPANEL_SUNSPEC_UNIT_ID is wrong"),
        ("MQTT_PUBLISH_INTERVAL_S", "0", "HELIOPANEL_MQTT_PUBLISH_INTERVAL_S is wrong"),
        ("MQTT_PAYLOAD", "columns", "HELIOPANEL_MQTT_PAYLOAD=trackers"),
    ],
)
def test_wrong_settings_are_named(monkeypatch: pytest.MonkeyPatch, name: str, value: str, words: str) -> None:
    monkeypatch.setenv("HELIOPANEL_MQTT_DISCOVERY", "true")
    monkeypatch.setenv(f"HELIOPANEL_{name}", value)
    with pytest.raises(SettingsWrong, match=words):
        read_settings()


def test_lists_are_read_and_the_password_is_never_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HELIOPANEL_SUNSPEC_WRITE_HOSTS", "127.0.0.1, 10.0.0.0/24,serial")
    monkeypatch.setenv("HELIOPANEL_MQTT_PASSWORD", "open sesame")
    found = read_settings()
    assert found.sunspec_write_hosts == ("127.0.0.1", "10.0.0.0/24", "serial")
    assert "sesame" not in found.model_dump_json()


async def test_a_taken_port_is_told_and_the_machine_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = await asyncio.start_server(lambda _, writer: writer.close(), "127.0.0.1", 0)
    monkeypatch.setenv("HELIOPANEL_SUNSPEC_PORT", str(taken.sockets[0].getsockname()[1]))
    monkeypatch.setenv("HELIOPANEL_SUNSPEC_SERIAL_PORT", str(tmp_path / "not-there"))
    async with kept_plant(tmp_path) as (plant, store):
        gateways = Gateways(plant.site, HurriedClock(), read_settings(), store)
        gateways.start()
        async with asyncio.timeout(PATIENCE_S):
            tcp, rtu, *_ = (await gateways.metrics()).gateways
            while not (tcp.error and rtu.error):
                await pause()
                tcp, rtu, *_ = (await gateways.metrics()).gateways
        await plant.forward(seconds=0.5)
        assert plant.tracker().measured is not None
        await gateways.close()
    taken.close()
    await taken.wait_closed()
    assert "choose another with HELIOPANEL_SUNSPEC_PORT" in tcp.error
    assert "Check that the adapter" in rtu.error


@pytest.mark.parametrize(
    ("given", "sentences"),
    [
        ({}, ("No host may write.", "No host may write.", "No commands are accepted.")),
        (
            {"sunspec_write_hosts": ("10.0.0.5", "serial"), "mqtt_commands": True},
            (
                "10.0.0.5 may write; all other hosts can only read.",
                "The master on the line may write.",
                "Any client that may publish below heliopanel at the broker may send commands.",
            ),
        ),
    ],
)
def test_every_door_says_who_may_write(given: dict[str, Any], sentences: tuple[str, ...]) -> None:
    assert tuple(writes(Settings(**given)).values()) == sentences
