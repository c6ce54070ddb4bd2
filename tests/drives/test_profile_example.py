"""The example in the page on writing a profile is a right profile, and means what the page says."""

import re

from app.drives.connections.profile_needs import check_needs
from app.drives.profile import Adapter, parse_profile
from app.simulation.profile_page import DOCS

PAGE = (DOCS / "writing-a-profile.md").read_text(encoding="utf-8")


def test_the_example_is_a_right_profile() -> None:
    example = re.search(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert example is not None
    profile = parse_profile(example[1], "my-servo.toml")
    check_needs(profile)
    assert profile.adapter is Adapter.CIA402
    assert profile.watchdog is not None
    assert profile.watchdog.register is None
    assert set(profile.registers) - set(profile.unverified) == {"controlword"}
    assert profile.registers["velocity"].optional


def test_the_page_names_every_adapter() -> None:
    assert all(f"| `{adapter}` |" in PAGE for adapter in Adapter)
