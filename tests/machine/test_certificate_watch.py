"""A certificate that is not valid, or will soon not be, is an alarm; it returns once there is another one."""

from collections.abc import AsyncIterator
from datetime import timedelta
from pathlib import Path

import pytest

from app.base import certificates
from app.base.certificates import AUTHORITY, SERVER, SERVER_KEY, init
from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.machine.certificate_watch import CODES, CertificateWatch
from tests.golden.table import ClockRow, clocks
from tests.site.plant import SUMMER_NOON, Plant, make_plant

NAMES = ("heliopanel.local",)


@pytest.fixture
async def plant() -> AsyncIterator[Plant]:
    built = make_plant()
    await built.start()
    await built.commission()
    yield built
    await built.close()


@pytest.fixture(autouse=True)
def built_long_ago(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the certificates of these tests made by software that is older than every clock."""
    monkeypatch.setattr(certificates, "BUILT_AT", SUMMER_NOON - timedelta(days=1000))


async def told(plant: Plant, settings: Settings, at: timedelta) -> dict[str, str]:
    """Return the alarms of the certificate at an instant, as the alarm list shows them."""
    watch = CertificateWatch(plant.clock, plant.site, lambda: settings)
    keeper = plant.site.model.timekeeper
    keeper._clock = VirtualClock(SUMMER_NOON + at)
    try:
        await watch.look()
    finally:
        keeper._clock = plant.clock
    await plant.forward(seconds=40)
    seen = plant.site.latest()
    assert seen is not None
    found = (one for one in seen.alarms if one.code in CODES and one.returned_at is None)
    return {one.code: f"{one.message} {one.do}" for one in found}


def rows(guard: str) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("row", clocks(guard), ids=lambda row: f"{row.stored} {row.later}")


@rows("certificate_alarm")
@pytest.mark.parametrize("whose", ["own", "given", "in the folder"])
async def test_the_certificate_is_an_alarm_from_thirty_days_before_its_end(
    plant: Plant, tmp_path: Path, row: ClockRow, whose: str
) -> None:
    init(tmp_path / "tls", NAMES, SUMMER_NOON + row.stored)
    settings = Settings(data_dir=tmp_path)
    if whose == "given":
        files = {"tls_cert_file": tmp_path / "tls" / SERVER, "tls_key_file": tmp_path / "tls" / SERVER_KEY}
        settings = Settings(data_dir=tmp_path, **files)
    elif whose == "in the folder":
        (tmp_path / "tls" / AUTHORITY).unlink()
    found = await told(plant, settings, row.asked + row.later)
    assert list(found) == ([row.expected] if row.expected else [])
    assert all("heliopanel tls init" in text for text in found.values())
    init(tmp_path / "tls", NAMES, SUMMER_NOON + row.asked + row.later)
    assert await told(plant, settings, row.asked + row.later) == {}


@rows("authority_alarm")
async def test_the_end_of_the_authority_is_told_with_what_to_do(
    plant: Plant, tmp_path: Path, row: ClockRow
) -> None:
    init(tmp_path / "tls", NAMES, SUMMER_NOON)
    now = SUMMER_NOON + row.later
    certificates.renew(tmp_path / "tls", now)
    found = await told(plant, Settings(data_dir=tmp_path), row.later)
    assert list(found) == ([row.expected] if row.expected else [])
    assert all("install the new authority on each tablet" in text for text in found.values())


async def test_nothing_is_told_without_https_or_by_a_clock_that_may_be_wrong(
    plant: Plant, tmp_path: Path
) -> None:
    assert await told(plant, Settings(data_dir=tmp_path), timedelta()) == {}
    init(tmp_path / "tls", NAMES, SUMMER_NOON)
    assert list(await told(plant, Settings(data_dir=tmp_path), timedelta(days=400))) == [
        "certificate_invalid"
    ]
    assert await told(plant, Settings(data_dir=tmp_path), timedelta(days=50700)) == {}


@pytest.mark.parametrize("broken", [SERVER, SERVER_KEY])
@pytest.mark.parametrize("content", [b"", b"no certificate", None], ids=["empty", "text", "of another pair"])
async def test_a_certificate_that_cannot_be_served_is_an_alarm_until_it_can(
    plant: Plant, tmp_path: Path, broken: str, content: bytes | None
) -> None:
    init(tmp_path / "tls", NAMES, SUMMER_NOON)
    if content is None:
        init(tmp_path / "other", NAMES, SUMMER_NOON)
        content = (tmp_path / "other" / broken).read_bytes()
    (tmp_path / "tls" / broken).write_bytes(content)
    found = await told(plant, Settings(data_dir=tmp_path), timedelta())
    assert list(found) == ["certificate_invalid"]
    assert "cannot be used" in found["certificate_invalid"]
    init(tmp_path / "tls", NAMES, SUMMER_NOON)
    assert await told(plant, Settings(data_dir=tmp_path), timedelta()) == {}
