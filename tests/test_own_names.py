"""By which names this computer may be called, also where its own name is none that a name server knows."""

import socket
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.base.addresses.own_names import ALWAYS, own_names
from app.base.certificates import init


@pytest.mark.parametrize("name", ["nowhere.invalid", "x" * 64])
def test_a_name_that_nobody_can_look_up_is_told_and_certified(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: name)
    found = own_names()
    assert found[: len(ALWAYS)] == ALWAYS
    assert name in found
    made = init(tmp_path / "tls", found, datetime(2026, 6, 21, tzinfo=UTC))
    assert name in made.names


def test_addresses_have_no_zone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A certificate for `fe80::1%eth0` cannot be made."""
    found = [(socket.AF_INET6, socket.SOCK_STREAM, 6, "", ("fe80::1%eth0", 0, 0, 2))]
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_: found)
    assert "fe80::1" in own_names()
    assert not any("%" in one for one in own_names())
