"""What earlier versions wrote is all there after the upgrade; no older program touches what newer ones wrote.

The folders are `tests/golden/databases`: each was written by the program of its version.
"""

import shutil
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from app.access import migrations as of_access
from app.access.store import AccessStore
from app.alarms.catalogue import entry_of
from app.base.build import VERSION
from app.store import software
from app.store.connections import reading_engine, revision_of, transaction
from app.store.engine import open_writer
from app.store.former import kind_of
from app.store.migrations import SCRIPTS, upgrade
from app.store.store import StoreUnfit
from app.store.tables import REVISION
from app.tracker.values.actors import actor_of
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product
from tests.golden.databases.folders import LARGEST, Folder, folders
from tests.golden.databases.questions import asked, lost, signed_in

FOLDERS = folders()
ALARMS, JOURNAL = "/api/v1/alarms/history?limit=1000", "/api/v1/journal?limit=1000"
FOR_GOOD = {"telemetry_retention_days": "100000", "journal_retention_days": "100000"}
"""What was written long ago is not to be removed for its age."""


@pytest.fixture(params=FOLDERS, ids=lambda folder: folder.version)
def folder(request: pytest.FixtureRequest) -> Folder:
    found: Folder = request.param
    return found


@pytest.fixture
def data(folder: Folder, tmp_path: Path) -> Path:
    """Return a copy of the folder's data."""
    folder.unpack(tmp_path / "data")
    return tmp_path / "data"


def url_of(data: Path) -> str:
    return f"sqlite:///{data / 'heliopanel.db'}"


def found_in(data: Path) -> tuple[str | None, str | None]:
    """Return the revision of the tables and the version that is noted in them."""
    engine = reading_engine(url_of(data))
    with transaction(engine) as connection:
        found = revision_of(connection), software.version_of(connection)
    engine.dispose()
    return found


def in_words_of_today(before: dict[str, Any]) -> dict[str, Any]:
    """Return what was told, with kinds of events, the controller's name, and advice as this version has them.

    What is stored keeps its words: kinds and that name are translated as they are read; advice and the
    names of activities are not stored.
    """
    told = {path.replace("/frames?", "/samples?"): _items(answer) for path, answer in before.items()}
    for one in told[ALARMS]:
        one["alarm"]["do"] = entry_of(one["alarm"]["code"]).do
    for one in told[JOURNAL]:
        one["event"]["kind"] = kind_of(one["event"]["kind"])
        one["event"]["actor"] = actor_of(one["event"]["actor"])
    for path, answer in told.items():
        for one in answer if isinstance(answer, list) else [answer]:
            _rename(one, "/shows/" in path)
    return told


def _items(answer: Any) -> Any:
    """Return a list as it is told today, without what says where it continues."""
    lists = [answer[name] for name in ("alarms", "entries") if name in answer]
    return lists[0] if isinstance(answer, dict) and lists else answer


FIELDS = {
    "sun_begin_at": "sun_start",
    "sun_end_at": "sun_end",
    "frame_count": "sample_count",
    "light_wm2": "irradiance_wm2",
}
OF_SHOWS = {"begin_at": "start", "end_at": "end"}


def _rename(told: dict[str, Any], is_show: bool) -> None:
    for former, name in (FIELDS | (OF_SHOWS if is_show else {})).items():
        if former in told:
            told[name] = told.pop(former)
    for part in told.values():
        if isinstance(part, dict):
            _rename(part, is_show=False)
    if "activities" in told:
        told["activities"] = ["setting_home" if one == "zeroing" else one for one in told["activities"]]


def test_there_is_a_folder_of_the_first_version_and_of_this_one() -> None:
    assert [one.version for one in FOLDERS][:1] == ["0.1.0"]
    assert FOLDERS[-1].version == VERSION, f"Run: python -m tests.golden.databases {VERSION}"
    assert all(one.size() <= LARGEST for one in FOLDERS)


def test_everything_is_there_after_the_upgrade(folder: Folder, data: Path) -> None:
    told = folder.told()
    show = next(path for path in told if "/shows/" in path)
    before, _ = found_in(data)
    product = Product.start(data, **FOR_GOOD)
    try:
        with closing(signed_in(product.url)) as browser:
            assert browser.get("/health").json()["version"] == VERSION
            assert lost(in_words_of_today(told), asked(browser, show)) == []
            assert browser.get("/trackers/T1").is_success
            one = Integrator(product.url)
            one.http = browser
            one.until(lambda seen: seen["homed"], "the zero is still trusted")
    finally:
        assert product.stop() == 0
    assert found_in(data) == (REVISION, VERSION)
    assert (data / f"heliopanel.db.before-{REVISION}").exists() is (before != REVISION)


def test_an_older_program_that_knows_the_tables_refuses_it(
    data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    upgrade(url_of(data))
    with closing(open_writer(url_of(data))) as writer:
        writer.save_software(VERSION)
    with closing(AccessStore(f"sqlite:///{data / 'access.db'}", b"")) as store:
        assert store.load().users
    for module in (software, of_access):
        monkeypatch.setattr(module, "VERSION", "0.1.9")
    with pytest.raises(
        StoreUnfit, match=rf"The database .*newer version.*\({VERSION}; this version is 0.1.9\)"
    ):
        upgrade(url_of(data))
    with (
        closing(AccessStore(f"sqlite:///{data / 'access.db'}", b"")) as store,
        pytest.raises(StoreUnfit, match=rf"The users .*newer version.*\({VERSION}; this version is 0.1.9\)"),
    ):
        store.load()


def test_a_program_whose_migrations_end_earlier_refuses_it(data: Path, tmp_path: Path) -> None:
    upgrade(url_of(data))
    before = (data / "heliopanel.db").read_bytes()
    shutil.copytree(SCRIPTS, tmp_path / "older")
    (newest,) = (tmp_path / "older" / "versions").glob(f"{REVISION}_*.py")
    newest.unlink()
    with pytest.raises(StoreUnfit, match=f"newer version .*revision {REVISION}; this version supports up to"):
        upgrade(url_of(data), scripts=tmp_path / "older")
    assert (data / "heliopanel.db").read_bytes() == before
