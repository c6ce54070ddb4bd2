"""What is said before anything starts: one sentence and exit code 2, or 1 for what may work another time."""

import io
import json
import os
import socket
import subprocess
import zipfile
from pathlib import Path

import pytest

from app.base.build import VERSION
from app.base.certificates import SERVER, SERVER_KEY, init
from app.base.settings import SettingsWrong
from app.machine import starting
from app.machine.starting import as_service, check_data_dir
from app.store.migrations import upgrade
from tests.command_line import Run, run
from tests.e2e.product import COMMAND
from tests.fake_data import NOON
from tests.ports import free_port

__all__ = ["run"]


@pytest.fixture
def data(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, run: Run) -> Path:
    """Return a data folder that the environment names, and a port that nobody uses."""
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("HELIOPANEL_PORT", str(free_port()))
    return tmp_path / "data"


@pytest.fixture
def never_served(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fail a test in which a service begins."""

    def fail(*_: object) -> None:
        raise AssertionError("It was started.")

    for module in ("app.cli.serve.supervise", "app.web.main.run"):
        monkeypatch.setattr(module, fail)


@pytest.mark.usefixtures("never_served")
@pytest.mark.parametrize("command", ["serve", "web", "controller"])
def test_a_data_folder_that_cannot_be_made_is_one_sentence(run: Run, tmp_path: Path, command: str) -> None:
    (tmp_path / "file").touch()
    code, out, err = run(command, "--data-dir", str(tmp_path / "file" / "data"))
    assert (code, out) == (2, "")
    assert err.startswith(f"The folder {tmp_path}/file/data cannot be made (Not a directory).")
    assert err.count("\n") == 1


@pytest.mark.parametrize("forbidden", ["", "heliopanel.db", "machine.lock"])
def test_what_belongs_to_another_user_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, forbidden: str
) -> None:
    (tmp_path / "heliopanel.db").touch()
    (tmp_path / "machine.lock").touch()
    check_data_dir(tmp_path)
    monkeypatch.setattr(starting.os, "access", lambda path, _: Path(path) != tmp_path / forbidden)
    with pytest.raises(SettingsWrong, match=r"cannot be written\. Give it to the user") as refused:
        check_data_dir(tmp_path)
    assert str(tmp_path / forbidden) in str(refused.value)


@pytest.mark.usefixtures("never_served")
@pytest.mark.parametrize(
    ("broken", "content"),
    [(SERVER, b""), (SERVER_KEY, b"no key"), (SERVER_KEY, None)],
    ids=["empty", "text", "of another pair"],
)
def test_a_certificate_that_cannot_be_served_is_one_sentence(
    run: Run, data: Path, broken: str, content: bytes | None
) -> None:
    """It may be put right while the controller runs, so the web process is started again: exit code 1."""
    init(data / "tls", ("heliopanel.local",), NOON)
    if content is None:
        init(data / "other", ("heliopanel.local",), NOON)
        content = (data / "other" / broken).read_bytes()
    (data / "tls" / broken).write_bytes(content)
    code, out, err = run("web")
    assert (code, out) == (1, "")
    assert err.startswith(
        f"The certificate {data}/tls/{SERVER} and the key {data}/tls/{SERVER_KEY} cannot be"
    )
    assert "cannot be used: " in err
    assert "Run heliopanel tls init" in err
    assert err.count("\n") == 1


@pytest.mark.usefixtures("data", "never_served")
@pytest.mark.parametrize("command", ["serve", "web"])
def test_a_busy_port_ends_serve_before_the_machine_starts(run: Run, command: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        code, out, err = run(command, "--port", str(port))
    assert (code, out) == (2, "")
    assert f"cannot listen on 127.0.0.1 port {port}: Address already in use. Stop the program" in err
    assert err.count("\n") == 1


@pytest.mark.usefixtures("data")
def test_options_count_before_the_environment_and_reach_what_is_started(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    port, file = free_port(), tmp_path / "settings.toml"
    file.write_text("tick_ms = 200\n")
    monkeypatch.setattr("app.cli.serve.supervise", lambda *_: None)
    options = ["--config", str(file), "--data-dir", str(tmp_path / "other"), "--port", str(port)]
    code, out, _ = run("serve", *options, "--host", "::1" if socket.has_ipv6 else "127.0.0.1")
    assert (code, "starting" in out) == (0, True)
    assert os.environ["HELIOPANEL_CONFIG"] == str(file)
    assert os.environ["HELIOPANEL_PORT"] == str(port)
    code, out, _ = run("config", "check")
    assert (code, "tick_ms = 200\n" in out, f"port = {port}\n" in out) == (0, True, True)
    assert f"data_dir = {tmp_path / 'other'}\n" in out


def test_names_are_completed_by_a_shell() -> None:
    words = {"_HELIOPANEL_COMPLETE": "complete_bash", "COMP_WORDS": "heliopanel sta", "COMP_CWORD": "1"}
    found = subprocess.run(
        [COMMAND], env=os.environ | words, capture_output=True, text=True, check=True
    ).stdout
    assert "status" in found
    assert "serve" not in found


def test_what_does_not_answer_is_told_with_exit_code_1(run: Run, data: Path) -> None:
    code, out, _ = run("status")
    assert code == 1
    assert f"data in {data}\nController service: does not answer\nPanel: does not answer at http://" in out
    code, out, _ = run("status", "--json")
    told = json.loads(out)
    assert (code, told["version"], told["controller_answers"], told["web_version"]) == (1, VERSION, False, "")


def test_diagnostics_are_written_of_what_is_there(run: Run, data: Path, tmp_path: Path) -> None:
    file = tmp_path / "told.zip"
    code, out, _ = run("diagnostics", str(file))
    assert (code, f"are in {file}" in out) == (0, True)
    with zipfile.ZipFile(io.BytesIO(file.read_bytes())) as archive:
        texts = {name: json.loads(archive.read(name)) for name in archive.namelist()}
    assert texts["about.json"]["version"] == VERSION
    assert texts["settings.json"]["data_dir"] == str(data)
    assert set(texts["missing.json"]) == {"journal", "controller"}
    assert file.stat().st_mode & 0o077 == 0
    code, _, err = run("diagnostics", str(file))
    assert (code, "exists already" in err) == (2, True)


def test_the_check_of_the_settings_leaves_nothing_behind(run: Run, data: Path) -> None:
    code, out, _ = run("config", "check")
    assert code == 0
    assert "There is no database yet" in out
    assert out.endswith("The settings are right.\n")
    assert not data.exists()
    upgrade(f"sqlite:///{data / 'heliopanel.db'}")
    assert "The database is at revision" in run("config", "check")[1]


@pytest.mark.usefixtures("data")
def test_a_mistyped_variable_is_told(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HELIOPANEL_MQTT_HOTS", "broker")
    code, _, err = run("config", "check")
    sentence = "HELIOPANEL_MQTT_HOTS is no setting and has no effect. Do you mean HELIOPANEL_MQTT_HOST?\n"
    assert (code, err) == (2, sentence)


@pytest.mark.usefixtures("data")
def test_passwords_are_not_printed(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HELIOPANEL_MQTT_PASSWORD", "SEKRET")
    monkeypatch.setenv("HELIOPANEL_DATABASE_URL", "postgresql+psycopg://me:SEKRET@/nowhere?host=/nowhere")
    code, out, err = run("config", "check")
    assert code == 1
    assert "mqtt_password = **********" in out
    assert "cannot be reached" in err
    assert "SEKRET" not in out + err


@pytest.mark.parametrize("fault", [ValueError("a bug"), OSError("a card was pulled")])
def test_a_fault_of_a_running_service_is_no_wrong_setting(
    fault: Exception, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended, as_service():
        raise fault
    assert ended.value.code == 1
    assert str(fault) in capsys.readouterr().err
