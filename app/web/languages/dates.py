"""Dates with the month in words, in the language of the request; a test holds them against the CLDR."""

from dataclasses import dataclass
from datetime import date

from app.web.languages import spoken


@dataclass(frozen=True, slots=True)
class Written:
    """How a language writes a date: with the year, and short without it; its twelve months for either."""

    full: str
    short: str
    months: tuple[str, ...]
    short_months: tuple[str, ...]


def _written(full: str, short: str, months: str, short_months: str) -> Written:
    return Written(full, short, tuple(months.split()), tuple(short_months.split()))


WRITTEN = {
    "en": _written(
        "{day:02d} {month} {year}",
        "{day:02d} {month}",
        "January February March April May June July August September October November December",
        "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec",
    ),
    "tr": _written(
        "{day} {month} {year}",
        "{day} {month}",
        "Ocak Şubat Mart Nisan Mayıs Haziran Temmuz Ağustos Eylül Ekim Kasım Aralık",
        "Oca Şub Mar Nis May Haz Tem Ağu Eyl Eki Kas Ara",
    ),
    "de": _written(
        "{day}. {month} {year}",
        "{day}. {month}",
        "Januar Februar März April Mai Juni Juli August September Oktober November Dezember",
        "Jan. Feb. März Apr. Mai Juni Juli Aug. Sept. Okt. Nov. Dez.",
    ),
    "es": _written(
        "{day} de {month} de {year}",
        "{day} {month}",
        "enero febrero marzo abril mayo junio julio agosto septiembre octubre noviembre diciembre",
        "ene feb mar abr may jun jul ago sept oct nov dic",
    ),
    "ro": _written(
        "{day} {month} {year}",
        "{day} {month}",
        "ianuarie februarie martie aprilie mai iunie iulie august septembrie octombrie noiembrie decembrie",
        "ian. feb. mar. apr. mai iun. iul. aug. sept. oct. nov. dec.",
    ),
    "zh_Hans": _written(
        "{year}年{month}{day}日",
        "{month}{day}日",
        "1月 2月 3月 4月 5月 6月 7月 8月 9月 10月 11月 12月",
        "1月 2月 3月 4月 5月 6月 7月 8月 9月 10月 11月 12月",
    ),
}


def spelled(on: date) -> str:
    """Return a date such as `21 June 2026`."""
    written = WRITTEN[spoken().code]
    return written.full.format(day=on.day, month=written.months[on.month - 1], year=on.year)


def day_and_month(on: date) -> str:
    """Return a date such as `21 Jun`."""
    written = WRITTEN[spoken().code]
    return written.short.format(day=on.day, month=written.short_months[on.month - 1])
