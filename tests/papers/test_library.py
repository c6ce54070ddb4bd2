"""The five papers: what comes out, and what does not."""

import re
from datetime import date

import pytest

from app.research import alexandru_published
from app.research.library import LIBRARY, UnknownPaper, paper, papers, shown, text
from app.research.nalini_table import TABLE_1
from app.research.result import Figure, Group, Standing
from tests.golden.table import numbers


def figures(key: str, title: str) -> dict[str, Figure]:
    group = next(group for group in paper(key).groups if group.title.startswith(title))
    return {figure.name: figure for figure in group.figures}


def test_nalinis_table_comes_out_row_by_row_but_for_the_day_that_is_printed_twice() -> None:
    table = figures("nalini-hemavathi", "Table 1, solar")
    assert len(table) == 50
    differing = [name for name, figure in table.items() if figure.standing is Standing.DIFFERS]
    assert differing == ["Dec-02 elevation", "Dec-02 azimuth"]
    misses = {name: figure.ours for name, figure in figures("nalini-hemavathi", "Table 1, greatest").items()}
    assert misses["by SPA with refraction, elevation"] == pytest.approx(0.0056, abs=5e-5)
    assert misses["by the paper's eqs 3, 16 and 17, elevation"] == pytest.approx(4.04, abs=0.005)


def test_the_published_numbers_are_those_of_the_papers() -> None:
    rows = [(row["elevation_deg"], row["azimuth_deg"]) for row in numbers("nalini_table1.csv")]
    assert [row[2:] for row in TABLE_1] == rows
    days = [date(2022, *row[:2]).timetuple().tm_yday for row in TABLE_1]
    assert days == [row["day_of_year"] for row in numbers("nalini_table1.csv")]
    table_4 = numbers("alexandru_table4.csv")
    assert list(alexandru_published.TABLE_4_GAINS_PERCENT) == [row["gain_percent"] for row in table_4]


def test_psa_in_32_bits_loses_the_sun_by_its_julian_day_and_lamms_cycle_begins_in_its_year() -> None:
    off = [figure.ours for figure in figures("psa-rexroth", "On a PLC").values()]
    assert off[:2] == pytest.approx([0.053, 0.021], rel=0.03)
    assert off[2] < 0.02
    assert off[3] == pytest.approx(0.0036, rel=0.05)
    rms_s = [figure.ours for figure in figures("xia", "Eq 4 against").values()]
    assert rms_s[0] < 1.0 < 3.5 < min(rms_s[1:4])


def test_alexandrus_energies_lengths_and_winter_gains() -> None:
    energies = figures("alexandru", "Section 4, figure 26")
    assert energies["net gain of table 3"].ours == pytest.approx(58.62, abs=0.01)
    assert energies["continuous, all day"].standing is Standing.DIFFERS
    for title in ("Section 2, the diurnal", "Section 2, the elevation"):
        lengths = [one for name, one in figures("alexandru", title).items() if name.startswith("length")]
        assert [one.standing for one in lengths] == [Standing.AGREES] * 2
    gains = figures("alexandru", "Table 4, gains")
    assert gains["10 June"].standing is Standing.AGREES
    winter = [gains[day] for day in ("17 January", "15 February", "15 November", "10 December")]
    assert all(gain.standing is Standing.DIFFERS for gain in winter)
    assert all(float(re.findall(r"\d+\.\d+", gain.remark)[0]) < 1.0 for gain in winter)


def test_the_text_tells_every_figure_and_why_one_differs() -> None:
    told = text(papers(("alexandru",)))
    assert "2003.71" in told
    assert all(gap.what in " ".join(told.split()) for gap in paper("alexandru").gaps)
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


def test_every_paper_is_summed_up_in_a_sentence() -> None:
    sums = {key: paper(key).summary for key in LIBRARY}
    assert sums["alexandru"].startswith(
        "49 of 67 published figures come out. Of these 5 are fitted, and 6 compare the paper with its own "
        "other numbers. 11 errata; the effect of 6 is measured."
    )
    assert sums["gezegin-dirik"].startswith("The one published figure that can be computed differs.")
    assert sums["psa-rexroth"].startswith("The one published figure that can be computed comes out.")
