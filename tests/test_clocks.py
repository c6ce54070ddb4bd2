"""The check finds each way by which a test could go by the real clock, and leaves events alone."""

from pathlib import Path

import pytest

from checks import clocks

OFFENCES = (
    "time.monotonic()", "from time import perf_counter", "loop.time()", "page.wait_for_timeout(5)",
    "time.sleep(0.1)", "asyncio.sleep(PAUSE_S)", "asyncio.timeout(5)", "asyncio.wait_for(what, 5.0)",
    "thread.join(5)", "ended.wait(20)", "httpx.get(url, timeout=60)", "eventually(found, within_s=3.0)",
)  # fmt: skip


def test_what_goes_by_the_real_clock_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clocks, "TESTS", tmp_path)
    file = tmp_path / "test_one.py"
    file.write_text("\n".join([*OFFENCES, "asyncio.sleep(0)", "process.wait()"]))
    assert {number for number, _ in clocks.offences(file)} == set(range(1, len(OFFENCES) + 1))


def test_on_the_patient_loop_the_loop_may_sleep_and_the_computer_may_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(clocks, "TESTS", tmp_path)
    file = tmp_path / "drives" / "test_one.py"
    file.parent.mkdir()
    file.write_text("asyncio.sleep(3600)\ntime.sleep(1)\n")
    assert clocks.offences(file) == [(2, "time.sleep(1)")]
