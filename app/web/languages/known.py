"""The languages that the panel speaks: their names, and how they write numbers, dates and the compass."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

LOCALE = Path(__file__).resolve().parents[1] / "locale"


@dataclass(frozen=True, slots=True)
class Language:
    """One language: its code for files, its tag for browsers, its name, numbers, dates and compass.

    `joints` are what stands between the parts of a list, `stop` is what ends a sentence.
    """

    code: str
    tag: str
    name: str
    point: str
    date: str
    compass: tuple[str, ...]
    joints: Mapping[str, str] = field(default_factory=dict)
    stop: str = "."


def _points(north: str, east: str, south: str, west: str) -> tuple[str, ...]:
    """Return the sixteen points of a compass whose letters are put together as in English."""
    letters = {"N": north, "E": east, "S": south, "W": west}
    return tuple("".join(letters[letter] for letter in point) for point in ENGLISH_POINTS)


_ENGLISH_POINTS = "N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW"
ENGLISH_POINTS = tuple(_ENGLISH_POINTS.split())
CHINESE_POINTS = (
    "北", "东北偏北", "东北", "东北偏东", "东", "东南偏东", "东南", "东南偏南",
    "南", "西南偏南", "西南", "西南偏西", "西", "西北偏西", "西北", "西北偏北",
)  # fmt: skip
CHINESE_JOINTS = {" and ": "和", " or ": "或", ", ": "、", ": ": "：", "; ": "；"}
ENGLISH = Language("en", "en", "English", ".", "%Y-%m-%d", ENGLISH_POINTS)
LANGUAGES = {
    language.code: language
    for language in (
        ENGLISH,
        Language(
            "tr",
            "tr",
            "Türkçe",
            ",",
            "%d.%m.%Y",
            _points("K", "D", "G", "B"),
            {" and ": " ve ", " or ": " veya "},
        ),
        Language(
            "de",
            "de",
            "Deutsch",
            ",",
            "%d.%m.%Y",
            _points("N", "O", "S", "W"),
            {" and ": " und ", " or ": " oder "},
        ),
        Language(
            "es",
            "es",
            "Español",
            ",",
            "%d/%m/%Y",
            _points("N", "E", "S", "O"),
            {" and ": " y ", " or ": " o "},
        ),
        Language(
            "ro",
            "ro",
            "Română",
            ",",
            "%d.%m.%Y",
            _points("N", "E", "S", "V"),
            {" and ": " și ", " or ": " sau "},
        ),
        Language("zh_Hans", "zh-Hans", "简体中文", ".", "%Y/%m/%d", CHINESE_POINTS, CHINESE_JOINTS, "。"),
    )
}
TRANSLATED = tuple(code for code in LANGUAGES if code != ENGLISH.code)


def code_of(tag: str) -> str:
    """Return the code of a browser's tag; of one that is not ours, English."""
    return next((code for code, language in LANGUAGES.items() if language.tag == tag), ENGLISH.code)


def in_words(value: object) -> str:
    """Return a word that travels, such as `going_to_start`, as people write it in English."""
    text = str(value).replace("_", " ").replace("-", " ")
    return text[:1].upper() + text[1:]
