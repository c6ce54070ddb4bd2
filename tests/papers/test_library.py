"""The five papers: what comes out, what does not, and what each misprint costs."""

import re
from datetime import date

import pytest

from app.research import alexandru_published
from app.research.effect import figures as significant
from app.research.library import LIBRARY, UnknownPaper, paper, papers, shown, text
from app.research.nalini_table import TABLE_1
from app.research.result import Figure, Group, Standing
from tests.golden.table import numbers


def figures(key: str, title: str) -> dict[str, Figure]:
    group = next(group for group in paper(key).groups if group.title.startswith(title))
    return {figure.name: figure for figure in group.figures}


def effect(key: str, where: str, printed: str = "") -> list[float]:
    """Return the numbers of an erratum's effect, in degrees as they stand."""
    found = next(one for one in paper(key).errata if one.where == where and printed in one.printed)
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?", found.effect.text)]


def test_nalinis_table_comes_out_row_by_row_but_for_the_day_that_is_printed_twice() -> None:
    table = figures("nalini-hemavathi", "Table 1, solar")
    assert len(table) == 50
    differing = [name for name, figure in table.items() if figure.standing is Standing.DIFFERS]
    assert differing == ["Dec-02 elevation", "Dec-02 azimuth"]
    assert table["Dec-02 elevation"].ours == pytest.approx(26.03, abs=0.006)
    assert table["Dec-02 azimuth"].ours == pytest.approx(122.60, abs=0.007)


def test_the_equations_of_nalinis_paper_miss_its_own_table() -> None:
    misses = {name: figure.ours for name, figure in figures("nalini-hemavathi", "Table 1, greatest").items()}
    assert misses["by SPA with refraction, elevation"] == pytest.approx(0.0056, abs=5e-5)
    assert misses["by SPA with refraction, azimuth"] == pytest.approx(0.0066, abs=5e-5)
    assert misses["by the paper's eqs 3, 16 and 17, elevation"] == pytest.approx(4.04, abs=0.005)
    assert misses["by the paper's eqs 3, 16 and 17, azimuth"] == pytest.approx(1.92, abs=0.005)
    assert misses["rows with the sun up, the printed UTC-5 taken at its word"] == 0.0


def test_the_published_numbers_are_those_of_the_papers() -> None:
    rows = [(row["elevation_deg"], row["azimuth_deg"]) for row in numbers("nalini_table1.csv")]
    assert [row[2:] for row in TABLE_1] == rows
    days = [date(2022, *row[:2]).timetuple().tm_yday for row in TABLE_1]
    assert days == [row["day_of_year"] for row in numbers("nalini_table1.csv")]
    table_4 = numbers("alexandru_table4.csv")
    assert list(alexandru_published.TABLE_4_GAINS_PERCENT) == [row["gain_percent"] for row in table_4]


def test_sunrise_by_nalinis_eq_6_is_off_by_a_right_angle() -> None:
    assert effect("nalini-hemavathi", "eq 6") == pytest.approx([-5.7345, -95.7345], abs=1e-4)
    assert effect("nalini-hemavathi", "eq 4")[0] == 114


@pytest.mark.parametrize(
    ("where", "printed", "greatest"),
    [
        ("eq 1", "no rule", 1.139),
        ("text, section 3", "", 45.0),
        ("eq 4", "", 0.0147),
        ("eq 19", "", 0.0148),
    ],
)
def test_what_the_misprints_of_gezegin_cost(where: str, printed: str, greatest: float) -> None:
    assert effect("gezegin-dirik", where, printed)[0] == pytest.approx(greatest, rel=0.01)


def test_the_century_terms_of_gezegins_eq_1_lose_the_sun() -> None:
    first_days, last_days, worst, rms, right, _ = effect("gezegin-dirik", "eq 1", "⌊Y/4⌋")
    assert (first_days, last_days) == (514, 527)
    assert worst == pytest.approx(46.1, abs=0.3)
    assert rms == pytest.approx(32.0, abs=0.5)
    assert right < 0.0127


def test_the_misprints_of_xia_and_the_year_that_opens_lamms_cycle() -> None:
    missing_sine, sun, *_ = effect("xia", "eq 3")
    assert missing_sine == pytest.approx(25.3, abs=0.05)
    assert sun > 25.0
    assert effect("xia", "eq 2")[1::2] == pytest.approx([51, 41, 25, 18, 21], abs=1)
    rms_s = [figure.ours for figure in figures("xia", "Eq 4 against").values()]
    assert rms_s[0] < 1.0 < 3.5 < min(rms_s[1:4])
    assert rms_s[4] == pytest.approx(6.3, abs=0.1)


def test_what_the_misprints_of_psa_cost() -> None:
    assert 0.5 < effect("psa-rexroth", "eq 1")[0] < 1.0
    assert effect("psa-rexroth", "eq 8")[0] == pytest.approx(180.0, abs=1.0)
    assert effect("psa-rexroth", "eq 14")[0] == pytest.approx(180.0, abs=1.0)
    assert effect("psa-rexroth", "eq 11")[1] > 90.0


def test_psa_in_32_bits_loses_the_sun_by_its_julian_day() -> None:
    off = [figure.ours for figure in figures("psa-rexroth", "On a PLC").values()]
    assert off[:2] == pytest.approx([0.053, 0.021], rel=0.03)
    assert off[2] < 0.02
    assert off[3] == pytest.approx(0.0036, rel=0.05)


def test_alexandrus_energies_angles_and_lengths() -> None:
    energies = figures("alexandru", "Section 4, figure 26")
    assert energies["fixed panel"].ours == pytest.approx(1209.30, abs=0.005)
    assert energies["program of table 3"].ours == pytest.approx(1929.78, abs=0.005)
    assert energies["net gain of table 3"].ours == pytest.approx(58.62, abs=0.01)
    assert energies["continuous, all day"].standing is Standing.DIFFERS
    better = figures("alexandru", "Table 3, whether")
    assert better["twelve best steps within 60°"].ours >= 1932.59
    assert better["eight best steps within 60°"].ours > energies["program of table 3"].ours
    assert all(
        figure.standing is Standing.AGREES for figure in figures("alexandru", "Table 4, decl").values()
    )
    for title in ("Section 2, the diurnal", "Section 2, the elevation"):
        lengths = [one for name, one in figures("alexandru", title).items() if name.startswith("length")]
        assert len(lengths) == 2
        assert all(length.standing is Standing.AGREES for length in lengths)


def test_alexandrus_winter_gains_would_take_air_clearer_than_clean() -> None:
    gains = figures("alexandru", "Table 4, gains")
    assert gains["10 June"].standing is Standing.AGREES
    winter = [gains[day] for day in ("17 January", "15 February", "15 November", "10 December")]
    assert all(gain.standing is Standing.DIFFERS for gain in winter)
    assert all(float(re.findall(r"\d+\.\d+", gain.remark)[0]) < 1.0 for gain in winter)
    assert gains["mean of the twelve printed gains"].ours == pytest.approx(42.003, abs=0.001)


def test_alexandrus_literal_tilt_lays_the_panel_flat() -> None:
    assert effect("alexandru", "eq 7") == pytest.approx([1439.9, 1209.3])
    assert effect("alexandru", "figure 24") == pytest.approx([0.79])


def test_the_text_tells_every_figure_and_why_one_differs() -> None:
    told = text(papers(("alexandru",)))
    assert "2003.71" in told
    assert "clean dry air has 1" in told
    assert all(gap.what in " ".join(told.split()) for gap in paper("alexandru").gaps)


def test_all_five_are_there_and_no_sixth() -> None:
    assert [one.key for one in papers()] == list(LIBRARY)
    with pytest.raises(UnknownPaper, match="choose one of"):
        papers(("a-sixth",))


def test_figures_are_counted_and_written_with_their_digits() -> None:
    near, far, alone = (
        Figure("near", "°", 1.0, 1.001, 0.01, 3),
        Figure("far", "°", 1.0, 2.0),
        Figure("alone", "", None, 3.0),
    )
    group = Group("Table", "", (near, far, alone))
    assert (group.agreeing, group.published) == (1, 2)
    assert shown(near) == ("1.000", "1.001", "+0.001")
    assert shown(alone) == ("", "3.00", "")
    assert [figure.standing.value for figure in group.figures] == ["agrees", "differs", "measured"]


def test_every_paper_is_summed_up_in_a_sentence() -> None:
    sums = {key: paper(key).summary for key in LIBRARY}
    assert sums["xia"] == "3 of 4 published figures come out. 7 errata; the effect of 7 is measured."
    assert sums["alexandru"].startswith(
        "49 of 67 published figures come out. Of these 5 are fitted, and 6 compare the paper with its own "
        "other numbers. 11 errata; the effect of 6 is measured."
    )
    assert sums["gezegin-dirik"].startswith("The one published figure that can be computed differs.")
    assert sums["psa-rexroth"].startswith("The one published figure that can be computed comes out.")


@pytest.mark.parametrize(
    ("value", "count", "shown_as"),
    [(7.1e-7, 1, "0.0000007"), (107.3, 2, "107"), (-5.73447, 5, "-5.7345"), (0.0, 1, "0")],
)
def test_measured_effects_are_never_powers_of_ten(value: float, count: int, shown_as: str) -> None:
    assert significant(value, count) == shown_as
