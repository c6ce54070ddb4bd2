"""What is typed on the strategy page, read into the domain's words and back."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import BaseModel

from app.base.message import N_, say, told_by
from app.base.names import tidy
from app.tracker.programs.step_table import (
    COLUMNS,
    TableWrong,
    from_table,
    number_text,
    time_text,
)
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.stepped import ANGLES, StepFrame, StepProgram, TimeBase
from app.tracker.settings.strategy import (
    Continuous,
    Deadband,
    EncoderDeadband,
    HybridConfig,
    Interval,
    IntervalAim,
    SimulatedLight,
    Stepped,
    Strategy,
)
from app.tracker.values import typed_numbers
from app.tracker.values.typed_numbers import written
from app.web.features.studies.strategy_contexts import ProgramRow, ProgramTable, StrategyChoice
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.forms import Typed, Unreadable, number

CHOICES = (
    StrategyChoice(
        "deadband",
        N_("Deadband"),
        N_(
            "The panel is at standstill until the sun is about to leave the deadband, then both axes "
            "move to the sun. Few starts at a known error: suitable for most trackers."
        ),
    ),
    StrategyChoice(
        "encoder-deadband",
        N_("Deadband in encoder counts"),
        N_(
            "Each axis uses its own encoder: at an error of the set number of counts, the axis moves "
            "until the error is 0."
        ),
    ),
    StrategyChoice(
        "continuous",
        N_("Continuous"),
        N_(
            "The setpoint follows the sun continuously. Smallest error; the motors and brakes work "
            "without pause, and after a power failure the tracker must be homed again."
        ),
    ),
    StrategyChoice(
        "interval",
        N_("Interval"),
        N_(
            "A move at a fixed interval in minutes, to the sun's current position or its position in "
            "the middle of the interval."
        ),
    ),
    StrategyChoice(
        "stepped",
        N_("Step program"),
        N_("The angles of the program below, each from its time of day on. Fewest moves."),
    ),
)
LABELS = {choice.kind: choice.label for choice in CHOICES}
AIMS = (
    (IntervalAim.MIDDLE.value, N_("half an interval ahead")),
    (IntervalAim.NOW.value, N_("to the current sun position")),
)
BASES = (
    (TimeBase.SOLAR.value, N_("Solar time")),
    (TimeBase.CLOCK.value, N_("Clock time, fixed to UTC")),
)
FRAMES = (
    (StepFrame.HORIZON.value, N_("Azimuth and elevation")),
    (StepFrame.EQUATOR.value, N_("Hour angle and declination")),
    (StepFrame.AXES.value, N_("The mount's own axes")),
)
EMPTY_ROWS = 3
LIGHTEST_WM2 = 2000
A_DAY_S = 86_400


class StrategyForm(BaseModel):
    """The choice as it was typed; all texts."""

    kind: str = ""
    deadband: str = ""
    counts: str = ""
    counts_per_turn: str = ""
    minutes: str = ""
    aim: str = ""


USUAL = {"counts": "10", "counts_per_turn": "3600", "minutes": "10", "aim": IntervalAim.MIDDLE.value}
"""What the fields of the other strategies show; a field that is emptied means none of them."""


class HybridForm(BaseModel):
    """The correction as it was typed; all texts."""

    enabled: str = ""
    threshold: str = ""
    gain: str = ""
    bound: str = ""
    decay: str = ""
    azimuth_off: str = ""
    elevation_off: str = ""
    cloud: str = ""


class ProgramForm(BaseModel):
    """A program as it was typed: its head, three columns, and a table to import instead."""

    program_name: str = ""
    base: str = "solar"
    offset: str = "0"
    angles: str = "horizon"
    at: list[str] = []
    first: list[str] = []
    second: list[str] = []
    table: Annotated[str, MAY_BE_ABSENT] = ""
    example: Annotated[str, MAY_BE_ABSENT] = ""
    do: Annotated[str, MAY_BE_ABSENT] = "save"


HEAD = ("program_name", "base", "offset", "angles")


def strategy_texts(config: TrackerConfig) -> dict[str, str]:
    """Return a tracker's strategy as the form shows it."""
    texts = USUAL | {"deadband": written(config.deadband_deg)}
    strategy = config.strategy
    texts["kind"] = strategy.kind
    match strategy:
        case EncoderDeadband():
            texts |= {"counts": str(strategy.counts), "counts_per_turn": str(strategy.counts_per_turn)}
        case Interval():
            texts |= {"minutes": str(strategy.minutes), "aim": strategy.aim.value}
        case Continuous() | Deadband() | Stepped():
            pass
    return texts


def read_strategy(typed: Typed, kept: Strategy) -> Strategy:
    """Return the strategy that was typed; what is wrong is noted in `typed`."""
    match typed.texts["kind"]:
        case "continuous":
            return Continuous()
        case "deadband":
            return Deadband()
        case "encoder-deadband":
            return typed.read("counts", lambda _: _counted(typed), kept)
        case "interval":
            minutes = typed.whole("minutes", N_("Minutes"), 1, 240)
            return Interval(minutes, typed.read("aim", _aim, IntervalAim.MIDDLE))
        case "stepped" if isinstance(kept, Stepped):
            return kept
        case "stepped":
            typed.errors["kind"] = N_("Step program: save a program in the table below first.")
        case _:
            typed.errors["kind"] = N_("Strategy: choose one from the list.")
    return kept


def hybrid_texts(hybrid: HybridConfig) -> dict[str, str]:
    """Return the correction as the form shows it."""
    return {
        "enabled": "yes" if hybrid.enabled else "",
        "threshold": written(hybrid.threshold_wm2, LIGHTEST_WM2),
        "gain": written(hybrid.gain_dps),
        "bound": written(hybrid.bound_deg),
        "decay": written(hybrid.decay_s, A_DAY_S),
        "azimuth_off": written(hybrid.simulated.azimuth_deg),
        "elevation_off": written(hybrid.simulated.elevation_deg),
        "cloud": written(hybrid.simulated.cloud * 100.0),
    }


def read_hybrid(typed: Typed) -> HybridConfig | None:
    """Return the correction that was typed, None while anything in it is wrong."""
    values = (
        typed.number("threshold", N_("Irradiance threshold"), 1, LIGHTEST_WM2, "W/m²"),
        typed.number("gain", N_("Gain"), 0.001, 10),
        typed.number("bound", N_("Correction limit"), 0.01, 10, "°"),
        typed.number("decay", N_("Decay time constant"), 0, A_DAY_S, "s"),
    )
    played = (
        typed.number("azimuth_off", N_("Simulated misalignment, azimuth"), -10, 10, "°"),
        typed.number("elevation_off", N_("Simulated misalignment, elevation"), -10, 10, "°"),
        typed.number("cloud", N_("Simulated cloud"), 0, 100, "%"),
    )
    if typed.errors:
        return None
    light = SimulatedLight(played[0], played[1], played[2] / 100.0)
    return HybridConfig(bool(typed.texts["enabled"]), *values, simulated=light)


def shown_program(program: StepProgram | None, *, note: str = "") -> ProgramTable:
    """Return a program as the table shows it, an empty table without one."""
    if program is None:
        return typed_program(ProgramForm())
    rows = tuple(
        ProgramRow(time_text(step.from_h), number_text(step.first_deg), number_text(step.second_deg))
        for step in program.steps
    )
    head = {
        "program_name": program.name,
        "base": program.time_base.value,
        "offset": written(program.utc_offset_h),
        "angles": program.frame.value,
    }
    return ProgramTable(Typed(head).form(HEAD), rows, ANGLES[program.frame], note=note)


def typed_program(form: ProgramForm, wrong: Sequence[str] = (), *, more: int = EMPTY_ROWS) -> ProgramTable:
    """Return the table as it was typed, with some rows more."""
    frame = StepFrame(form.angles) if form.angles in list(StepFrame) else StepFrame.HORIZON
    rows = tuple(ProgramRow(*cells) for cells in zip(form.at, form.first, form.second, strict=False))
    head = {name: getattr(form, name) for name in HEAD}
    return ProgramTable(Typed(head).form(HEAD), rows + (ProgramRow(),) * more, ANGLES[frame], tuple(wrong))


def read_program(form: ProgramForm) -> StepProgram:
    """Return the program of the table; rows that are empty do not count. Raises `TableWrong`."""
    if form.angles not in list(StepFrame) or form.base not in list(TimeBase):
        raise TableWrong(N_("Choose the time base and the type of angles from the lists."))
    column = "solar_time" if form.base == TimeBase.SOLAR else f"clock_time{_offset(form.offset)}"
    head = ",".join((column, *COLUMNS[StepFrame(form.angles)]))
    rows = [
        ",".join(f'"{_cell(cell)}"' for cell in cells) if any(cell.strip() for cell in cells) else ""
        for cells in zip(form.at, form.first, form.second, strict=False)
    ]
    try:
        return from_table("\n".join([head, *rows]), name=tidy(form.program_name) or N_("My program"))
    except TableWrong as error:
        raise TableWrong(*(_row_of_table(sentence) for sentence in error.sentences)) from error


def _cell(text: str) -> str:
    """Return a typed number as a table has it; any other text is left for the table to read."""
    value = typed_numbers.value(typed_numbers.plain(text, "°"))
    return text.strip() if value is None else number_text(value)


def _row_of_table(sentence: str) -> str:
    """Return a sentence with the row counted as people see it: the head of the table is none."""
    word, _, rest = sentence.partition(" ")
    digits = "".join(filter(str.isdigit, rest.split(",")[0].split(":")[0].split(" ")[0]))
    if word != "Row" or not digits:
        return sentence
    return say("Row {digits}{rest}", digits=int(digits) - 1, rest=rest[len(digits) :])


def _offset(text: str) -> str:
    try:
        hours = number(text.strip() or "0", N_("UTC offset"), -99, 99, "h")
    except Unreadable as error:
        raise TableWrong(N_("UTC offset: type hours, such as 3 or -3.5.")) from error
    minutes = round(abs(hours) * 60.0)
    return f"_utc{'-' if hours < 0 else '+'}{minutes // 60:02d}:{minutes % 60:02d}"


def _counted(typed: Typed) -> Strategy:
    counts = typed.whole("counts", N_("Counts"), 1, 1_000_000)
    per_turn = typed.whole("counts_per_turn", N_("Counts per turn"), 1, 10_000_000)
    try:
        return EncoderDeadband(counts, per_turn)
    except ValueError as error:
        raise Unreadable(told_by(error)) from error


def _aim(text: str) -> IntervalAim:
    if text not in list(IntervalAim):
        raise Unreadable(N_("Move target: choose one from the list."))
    return IntervalAim(text)
