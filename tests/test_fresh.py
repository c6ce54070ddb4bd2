"""What `make fresh` reads from the README and from this computer's configuration."""

from pathlib import Path

import pytest

from tests.fresh import host
from tests.fresh.__main__ import NAMED, SAID, named_by_readme

ROOT = Path(__file__).resolve().parents[1]


def test_the_readme_names_what_a_debian_needs() -> None:
    """The machine installs this line and nothing else."""
    assert "git make python3-venv" in named_by_readme((ROOT / "README.md").read_text())
    assert (
        NAMED.search("```\nsudo apt-get install git make    # once\nmake run\n```")[1]
        == "apt-get install git make"
    )
    assert not NAMED.search("a font (`apt-get install fonts-noto-cjk`)")
    with pytest.raises(SystemExit):
        named_by_readme("make run")


def test_what_make_test_says_is_a_command() -> None:
    """The sentence of the script is understood."""
    script = (ROOT / "tests/system-packages.sh").read_text()
    told = "Install them with: sudo apt-get install --no-install-recommends"
    assert told + "$missing" in script
    assert SAID.search(f"The tests need: gcc npm. {told} gcc npm\n")[1].endswith(" gcc npm")


def test_sources_are_those_of_this_computer_for_another_debian() -> None:
    """Foreign archives stay out; suites that Debian has get the other release's name."""
    told = (
        "http://here.example/debian/ bookworm main\n"
        "http://here.example/debian/ bookworm contrib\n"
        "http://here.example/security/ bookworm-security main\n"
        "https://other.example/sql/ bookworm-pgdg main\n"
    )
    lines = [line.split("] ")[1] for line in host.apt_sources("13", told, "bookworm")]
    assert lines == [
        "http://here.example/debian/ trixie main",
        "http://here.example/debian/ trixie contrib",
        "http://here.example/security/ trixie-security main",
    ]
    assert " testing-security " in host.apt_sources("testing", told, "bookworm")[2]


def test_pip_settings_are_written_as_pip_reads_them() -> None:
    """Lists stay lists; what comes from the environment is passed on as such."""
    told = ":env:.cert='/a'\nglobal.extra-index-url='\\nfile:///b/simple\\nfile:///c/simple'\nglobal.timeout='9'\n"
    assert host.pip_settings(told) == (
        "[global]\nextra-index-url = file:///b/simple\n    file:///c/simple\ntimeout = 9\n"
    )


def test_local_folders_that_are_named_are_seen(tmp_path: Path) -> None:
    """An index on the disk with the files beside it; certificates of the system are the machine's own."""
    index, wheels = tmp_path / "index" / "simple", tmp_path / "wheels"
    index.mkdir(parents=True)
    wheels.mkdir()
    named = f"extra = file://{index}\n    file://{tmp_path}/absent/simple\n"
    assert host.folders(named, str(wheels), "/etc/ssl/certs", "https://here.example/simple", "8") == [
        index.parent,
        wheels,
    ]
