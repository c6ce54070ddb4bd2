"""A profile's register map as a page for people; `python -m app.drives.profile_page` renews docs/connect."""

from collections.abc import Iterable, Mapping

from app.drives.faults import FaultKind
from app.drives.profile import Adapter, Profile, known_profiles, load_profile
from app.drives.register import Register, WordOrder
from app.drives.sim_training import REGISTERS as TRAINING
from app.own import own_folder

DOCS = own_folder("docs") / "connect"
MARK = (
    "<!-- From here on made by `python -m app.drives.profile_page`: change the profile, not this page. -->\n"
)
HEAD = """
## Register map of profile `{name}`

Made from `app/drives/profiles/{name}.toml`. {verified} Source, where a line names no other: {source}.

All values are holding registers at zero-based Modbus addresses. A 32-bit value takes two registers, {order}
word first unless the table says otherwise. The value in its unit is the integer times the scale. A reply that
takes longer than {timeout_ms} ms counts as none.{rest}{steps}
"""
BLOCK = """
Block `{name}` is read in one frame: {count} registers from {address} on; addresses in it that the table
leaves out are not looked at.
"""
WATCHDOG = """
## Watchdog

Fed by {food}. Without that for {timeout_ms} ms it trips. {action}
"""
NO_WATCHDOG = """
## Watchdog

None is known. What the device was told last it goes on doing, so hand motion is made of short steps: each is
no longer than 240 ms at its speed and the ramp behind it, and the axis comes to rest by itself after it.
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
    """Return a profile's registers, words and watchdog as Markdown."""
    parts = [
        _head(profile),
        *(
            BLOCK.format(name=block.name, count=block.count, address=_number(block.address))
            for block in profile.blocks.values()
        ),
        _table(profile.registers.values()),
        *(_numbers(f"Bits of `{name}`", "bit", bits) for name, bits in profile.bits.items()),
        *(_numbers(f"Words of `{name}`", "number", words) for name, words in profile.enums.items()),
        _sequences(profile),
        _watchdog(profile),
    ]
    if profile.name == "simulated-plc":
        faults = ", ".join(f"{number} {kind}" for number, kind in enumerate(FaultKind, start=1))
        parts += [TRAINING_TEXT.format(faults=faults), _table(TRAINING)]
    return "".join(parts)


def renewed(written: str, profile: Profile) -> str:
    """Return a drive's page with its register map made anew, the text of people above it kept."""
    return written.partition(MARK)[0] + MARK + page(profile)


def _head(profile: Profile) -> str:
    unverified = ", ".join(f"`{name}`" for name in profile.unverified)
    rest = f" The line rests {profile.rest_ms} ms between two frames." if profile.rest_ms else ""
    steps = f" One motor revolution has {profile.steps_per_revolution:g} steps unless set otherwise."
    return HEAD.format(
        name=profile.name,
        source=profile.source,
        verified=f"Not verified: {unverified}." if unverified else "Every register is verified.",
        order="high" if profile.word_order is WordOrder.HIGH_FIRST else "low",
        timeout_ms=profile.timeout_ms,
        rest=rest,
        steps=steps if profile.adapter.has_unit_per_axis else "",
    )


def _sequences(profile: Profile) -> str:
    if not profile.sequences:
        return ""
    lines = ["\n### Sequences\n", "| name | writes |", "| --- | --- |"]
    for name, steps in profile.sequences.items():
        writes = ", then ".join(f"`{step.register}` = {step.value:#x}" for step in steps)
        lines.append(f"| `{name}` | {writes} |")
    return "\n".join(lines) + "\n"


def _watchdog(profile: Profile) -> str:
    watchdog = profile.watchdog
    if watchdog is None:
        return NO_WATCHDOG if profile.adapter is not Adapter.PLC else ""
    food = f"a new value in `{watchdog.register}`" if watchdog.register is not None else "any request"
    return WATCHDOG.format(food=food, timeout_ms=watchdog.timeout_ms, action=watchdog.action)


def _table(registers: Iterable[Register]) -> str:
    lines = ["", "| address | name | type | scale | unit | access | meaning |", "| --- " * 7 + "|"]
    lines += [
        f"| {_addresses(one)} | `{one.name}` | {one.type} | {one.scale:g} | {one.unit} | {one.access} | "
        f"{_meaning(one)} |"
        for one in registers
    ]
    return "\n".join(lines) + "\n"


def _addresses(register: Register) -> str:
    first = _number(register.address)
    return f"{first}, +1" if register.is_wide else first


def _number(address: int) -> str:
    """Return an address as engineers write it: small ones and SunSpec's in decimal, the others in hex."""
    return str(address) if address < 1000 or address >= 40000 else f"0x{address:04X}"


def _meaning(register: Register) -> str:
    if not register.source:
        mark = ""
    elif register.verified:
        mark = f"verified: {register.source}"
    else:
        mark = "*unverified*"
    optional = "omitted if the device refuses it" if register.optional else ""
    limits = ""
    if register.minimum is not None and register.maximum is not None:
        limits = f"plausible from {register.minimum:g} to {register.maximum:g}"
    return "; ".join(part for part in (register.text, limits, optional, mark) if part)


def _numbers(title: str, column: str, numbers: Mapping[str, int]) -> str:
    lines = [f"\n### {title}\n", f"| {column} | word |", "| --- | --- |"]
    lines += [f"| {number} | `{word}` |" for word, number in numbers.items()]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the page of every profile that ships."""
    for name in known_profiles():
        path = DOCS / f"{name}.md"
        path.write_text(renewed(path.read_text(encoding="utf-8"), load_profile(name)), encoding="utf-8")


if __name__ == "__main__":
    main()
