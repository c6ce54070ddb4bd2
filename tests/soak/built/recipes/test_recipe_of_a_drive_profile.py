"""The recipe of a drive profile in docs/develop/contributing.md, followed in a copy: one file is enough."""

from pathlib import Path

import pytest

from tests.soak.built.recipes.program_copy import ROOT, followed

KNOWN = (ROOT / "app/drives/profiles/leadshine-rs.toml").read_text(encoding="utf-8")
PROFILE = KNOWN.replace('name = "leadshine-rs"', 'name = "northfield-servo"', 1)
NEW = {"app/drives/profiles/northfield-servo.toml": PROFILE}
PROOF = """
from typer.testing import CliRunner

from app.cli.profiles import drive
from app.drives.profile import known_profiles, load_profile

assert "northfield-servo" in known_profiles()
assert load_profile("northfield-servo").name == "northfield-servo"
listed = CliRunner().invoke(drive, ("profiles",))
assert listed.exit_code == 0 and "northfield-servo" in listed.output, listed.output
checked = CliRunner().invoke(drive, ("check", "northfield-servo"))
print(checked.exit_code, checked.exception, checked.output)
"""


def test_a_drive_profile_is_added_in_one_file(tmp_path: Path) -> None:
    assert len(NEW) == 1
    assert followed(tmp_path, {}, NEW, PROOF)[:2] == ["0", "None"]


def test_a_register_of_an_unknown_type_is_refused(tmp_path: Path) -> None:
    wrong = {name: text.replace('"uint16"', '"uint15"', 1) for name, text in NEW.items()}
    with pytest.raises(AssertionError, match="uint15"):
        followed(tmp_path, {}, wrong, PROOF)
