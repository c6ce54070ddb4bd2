"""A profile's register map as a page; `python -m app.simulation.profile_page` renews docs/connect."""

from collections.abc import Iterable, Mapping

from app.base.message import N_, say, with_format
from app.base.own import own_folder
from app.drives.profile import Adapter, Profile, known_profiles, load_profile
from app.drives.register import Register, WordOrder
from app.simulation.faults import FaultKind
from app.simulation.sim_training import REGISTERS as TRAINING

DOCS = own_folder("docs") / "connect"
MARK = (
    "<!-- From here on made by `python -m app.simulation.profile_page`: "
    "change the profile, not this page. -->\n"
)
HEAD = """
## Register map of profile `{name}`

Made from `app/drives/profiles/{name}.toml`. {verified} Source, where a line names no other: {source}.

All values are holding registers at zero-based Modbus addresses. A 32-bit value takes two registers, {order}
word first unless the table says otherwise. The value in its unit is the integer times the scale. A reply that
takes longer than {timeout_ms} ms counts as none.{rest}{steps}
"""
BLOCK = """
Block `{name}` is read in one frame: {count} registers from {address} on; addresses in it that are not
in the table are ignored.
"""
WATCHDOG = """
## Watchdog

Fed by {food}. Without that for {timeout_ms} ms it trips. {action}
"""
NO_WATCHDOG = """
## Watchdog

None is known. The device continues with its last command, so a jog is made of short increments: each is no
longer than 240 ms at its speed and the ramp after it, and the axis stops at its end.
"""
TRAINING_TEXT = """
## Training

Only `heliopanel drive-sim` has these registers, not a real device. Write the first four in one frame to
inject a fault; they answer even while a fault of the connection is injected.

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
        *(_numbers(say("Bits of `{name}`", name=name), "bit", bits) for name, bits in profile.bits.items()),
        *(
            _numbers(say("Words of `{name}`", name=name), "number", words)
            for name, words in profile.enums.items()
        ),
        _sequences(profile),
        _watchdog(profile),
    ]
    if profile.name == "simulated-plc":
        faults = ", ".join(f"{number} {kind}" for number, kind in enumerate(FaultKind, start=1))
        parts += [TRAINING_TEXT.format(faults=faults), _table(TRAINING)]
    return "".join(parts)


def renewed(written: str, profile: Profile) -> str:
    """Return a drive's page with its register map made anew, the written text above it kept."""
    return written.partition(MARK)[0] + MARK + page(profile)


def _head(profile: Profile) -> str:
    unverified = ", ".join(f"`{name}`" for name in profile.unverified)
    rest = f" The line is silent for {profile.rest_ms} ms between two frames." if profile.rest_ms else ""
    steps = f" One motor revolution has {profile.steps_per_revolution:g} steps unless set otherwise."
    return HEAD.format(
        name=profile.name,
        source=profile.source,
        verified=say("Not verified: {unverified}.", unverified=unverified)
        if unverified
        else N_("Every register is verified."),
        order="high" if profile.word_order is WordOrder.HIGH_FIRST else "low",
        timeout_ms=profile.timeout_ms,
        rest=rest,
        steps=steps if profile.adapter.has_unit_per_axis else "",
    )


def _sequences(profile: Profile) -> str:
    if not profile.sequences:
        return ""
    lines = ["\n### Sequences\n", N_("| name | writes |"), "| --- | --- |"]
    for name, steps in profile.sequences.items():
        writes = ", then ".join(f"`{step.register}` = {step.value:#x}" for step in steps)
        lines.append(f"| `{name}` | {writes} |")
    return "\n".join(lines) + "\n"


def _watchdog(profile: Profile) -> str:
    watchdog = profile.watchdog
    if watchdog is None:
        return NO_WATCHDOG if profile.adapter is not Adapter.PLC else ""
    food = (
        say("a new value in `{register}`", register=watchdog.register)
        if watchdog.register is not None
        else N_("any request")
    )
    return WATCHDOG.format(food=food, timeout_ms=watchdog.timeout_ms, action=watchdog.action)


def _table(registers: Iterable[Register]) -> str:
    lines = ["", N_("| address | name | type | scale | unit | access | meaning |"), "| --- " * 7 + "|"]
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
        mark = say("verified: {source}", source=register.source)
    else:
        mark = "*unverified*"
    optional = N_("omitted if the device refuses it") if register.optional else ""
    limits = ""
    if register.minimum is not None and register.maximum is not None:
        limits = say(
            "plausible from {minimum} to {maximum}",
            minimum=with_format(register.minimum, "g"),
            maximum=with_format(register.maximum, "g"),
        )
    return "; ".join(part for part in (register.text, limits, optional, mark) if part)


def _numbers(title: str, column: str, numbers: Mapping[str, int]) -> str:
    lines = [f"\n### {title}\n", say("| {column} | word |", column=column), "| --- | --- |"]
    lines += [f"| {number} | `{word}` |" for word, number in numbers.items()]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the page of every profile that ships."""
    for name in known_profiles():
        path = DOCS / f"{name}.md"
        path.write_text(renewed(path.read_text(encoding="utf-8"), load_profile(name)), encoding="utf-8")


if __name__ == "__main__":
    main()
