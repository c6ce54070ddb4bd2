"""A drive profile: what its recipe changes and adds, and the proof that it works."""

from tests.soak.built.recipes.program_copy import ROOT

KNOWN = (ROOT / "app/drives/profiles/leadshine-rs.toml").read_text(encoding="utf-8")
PROFILE = KNOWN.replace('name = "leadshine-rs"', 'name = "northfield-servo"', 1)
NEW = {"app/drives/profiles/northfield-servo.toml": PROFILE}
EDITS: dict[str, tuple[tuple[str, str], ...]] = {}
PROOF = """
from typer.testing import CliRunner

from app.cli.profiles import drive
from app.drives.profile import known_profiles, load_profile

assert "northfield-servo" in known_profiles()
assert load_profile("northfield-servo").name == "northfield-servo"
listed = CliRunner().invoke(drive, ("profiles",))
assert listed.exit_code == 0 and "northfield-servo" in listed.output, listed.output
checked = CliRunner().invoke(drive, ("check", "northfield-servo"))
assert (checked.exit_code, checked.exception) == (0, None), checked.output
"""
