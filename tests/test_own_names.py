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
