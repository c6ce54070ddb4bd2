"""A profile's register map as a page for people; `python -m app.drives.profile_page` renews docs/drives."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from app.drives.faults import FaultKind
from app.drives.profile import Profile, known_profiles, load_profile
from app.drives.register import Register
from app.drives.sim_training import REGISTERS as TRAINING

DOCS = Path(__file__).resolve().parents[2] / "docs" / "drives"
HEAD = """# {title} (profile `{name}`)

Made from `app/drives/profiles/{name}.toml` by `python -m app.drives.profile_page`; change the profile, not
this page. {verified} Source: {source}.

All values are holding registers at zero-based Modbus addresses, also readable as input registers. A 32-bit
value takes two registers, high word first unless the table says otherwise. The value in its unit is the
integer times the scale. The status block is read in one frame: {count} registers from {address} on; addresses
in it that the table leaves out read zero. A reply that takes longer than {timeout_ms} ms counts as none.
"""
WATCHDOG = """
## Watchdog

Fed by a new value in `{register}`. Without one for {timeout_ms} ms it trips. {action}
"""
TRAINING_TEXT = """
## Training

Only `heliopanel drive-sim` has these registers, not a real device. Write the first four in one frame to play
a fault; they answer even while a fault of the connection is played.

Faults by number: {faults}.

In `heliopanel drive-sim` discrete inputs 0 to 15 are the bits of `status`, 16 to 31 those of `switches`, and
coil 0 stops both axes.
"""


def page(profile: Profile) -> str:
    """Return a profile as Markdown."""
    block = profile.blocks["status"]
    parts = [
        HEAD.format(
            title=profile.title,
            name=profile.name,
            source=profile.source,
            verified="Every line is verified." if profile.verified else "Lines marked *unverified* are not.",
            count=block.count,
            address=block.address,
            timeout_ms=profile.timeout_ms,
        ),
        _table(profile.registers.values()),
        *(_numbers(f"Bits of `{name}`", "bit", bits) for name, bits in profile.bits.items()),
        *(_numbers(f"Enumeration {name}", "number", words) for name, words in profile.enums.items()),
    ]
    if profile.watchdog is not None:
        watchdog = profile.watchdog
        parts.append(
            WATCHDOG.format(
                register=watchdog.register, timeout_ms=watchdog.timeout_ms, action=watchdog.action
            )
        )
    if profile.name == "simulated-plc":
        faults = ", ".join(f"{number} {kind}" for number, kind in enumerate(FaultKind, start=1))
        parts += [TRAINING_TEXT.format(faults=faults), _table(TRAINING)]
    return "".join(parts)


def _table(registers: Iterable[Register]) -> str:
    lines = ["", "| address | name | type | scale | unit | access | meaning |", "| --- " * 7 + "|"]
    lines += [
        f"| {_addresses(one)} | `{one.name}` | {one.type} | {one.scale:g} | {one.unit} | {one.access} | "
        f"{_meaning(one)} |"
        for one in registers
    ]
    return "\n".join(lines) + "\n"


def _addresses(register: Register) -> str:
    return f"{register.address}-{register.address + 1}" if register.is_wide else str(register.address)


def _meaning(register: Register) -> str:
    unverified = "" if register.verified or not register.source else "*unverified*"
    limits = ""
    if register.minimum is not None and register.maximum is not None:
        limits = f"plausible from {register.minimum:g} to {register.maximum:g}"
    return "; ".join(part for part in (register.text, limits, unverified) if part)


def _numbers(title: str, column: str, numbers: Mapping[str, int]) -> str:
    lines = [f"\n## {title}\n", f"| {column} | word |", "| --- | --- |"]
    lines += [f"| {number} | `{word}` |" for word, number in numbers.items()]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the page of every profile that ships."""
    for name in known_profiles():
        (DOCS / f"{name}.md").write_text(page(load_profile(name)), encoding="utf-8")


if __name__ == "__main__":
    main()
