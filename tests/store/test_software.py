"""A database knows which version wrote it last; an older one leaves it alone, whatever its tables are."""

from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.base.build import VERSION
from app.store import software
from app.store.backup.backup import backup
from app.store.backup.restore import restore
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.store.software import is_newer
from app.store.store import StoreUnfit
from tests.fault_result import FaultResult
from tests.store.samples import SITE

NEWER = "999.0.1"
NOW = datetime(2026, 11, 21, 9, tzinfo=UTC)


def written_by(url: str, version: str) -> str:
    """Have a database tell that a version wrote it, and return its address."""
    writer = open_writer(url)
    writer.save_site(SITE)
    writer.save_software(version)
    writer.close()
    return url


@pytest.mark.parametrize(
    ("version", "than", "newer"),
    [
        ("0.1.0", "0.1.0", False),
        ("0.1.1", "0.1.0", True),
        ("0.9.0", "0.10.0", False),
        ("1.0.0", "0.99.99", True),
        ("0.2.0rc1", "9.0.0", True),
        ("0.2.0rc1", "0.2.0rc1", False),
    ],
)
def test_versions_are_ordered_by_their_numbers(version: str, than: str, newer: bool) -> None:
    assert is_newer(version, than) is newer


@pytest.mark.fault(72)
def test_what_a_newer_version_wrote_is_refused_with_the_same_tables(url: str, fault: FaultResult) -> None:
    written_by(url, NEWER)
    with pytest.raises(
        StoreUnfit, match=rf"newer version of Heliopanel \({NEWER}; this version is"
    ) as refused:
        upgrade(url)
    assert refused.value.exit_code == 2
    reader = open_reader(url)
    assert reader.site() == SITE
    reader.close()
    fault.prevented("refused before anything is changed")
    fault.shows(str(refused.value).replace(f"this version is {VERSION}", "this version is VERSION"))
    fault.recovers("the newer version is installed again, or a backup of this version is restored")


def test_what_an_older_version_wrote_is_taken(url: str) -> None:
    upgrade(written_by(url, "0.0.9"))
    with closing(open_writer(url)) as writer:
        writer.save_software(VERSION)
        assert writer.software() == VERSION


def test_a_backup_tells_which_version_wrote_it_and_a_newer_one_is_refused(
    url: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(software, "VERSION", NEWER)
    kept = backup(written_by(url, NEWER), tmp_path / "kept.backup").path
    monkeypatch.undo()
    written_by(url, VERSION)
    with pytest.raises(StoreUnfit, match=NEWER):
        restore(kept, url, NOW)
    upgrade(url)
