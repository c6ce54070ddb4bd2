"""The languages that the panel speaks: their names, and how they write numbers, dates and the compass."""

from dataclasses import dataclass
from pathlib import Path

LOCALE = Path(__file__).resolve().parents[1] / "locale"


@dataclass(frozen=True, slots=True)
class Language:
    """One language: its code for files, its tag for browsers, its own name, its numbers and dates."""

    code: str
    tag: str
    name: str
    point: str = "."
    date: str = "%Y-%m-%d"


ENGLISH = Language("en", "en", "English")
LANGUAGES = {
    language.code: language
    for language in (
        ENGLISH,
        Language("tr", "tr", "Türkçe", ",", "%d.%m.%Y"),
        Language("de", "de", "Deutsch", ",", "%d.%m.%Y"),
        Language("es", "es", "Español", ",", "%d/%m/%Y"),
        Language("ro", "ro", "Română", ",", "%d.%m.%Y"),
        Language("zh_Hans", "zh-Hans", "简体中文", ".", "%Y/%m/%d"),
    )
}
TRANSLATED = tuple(code for code in LANGUAGES if code != ENGLISH.code)
