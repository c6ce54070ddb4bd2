"""What a page is sent while it stands: its sentences in another language, names and codes as they are."""

import re
from pathlib import Path

import orjson

from app.web.languages.live_texts import SENTENCES, in_language
from tests.web.languages.made_up import GERMAN, catalogue

TEMPLATES = Path(__file__).resolve().parents[3] / "templates"
ALARM = {"code": "drive_lost", "title": "Azimuth", "message": "The drive of T7 does not answer."}


def test_sentences_are_said_and_names_are_not() -> None:
    german = catalogue(GERMAN | {"Site": "Anlage"})
    alarms = [{**ALARM, "tracker_id": "T7", "where": "Site"}, {**ALARM, "tracker_id": None, "where": "Site"}]
    told = orjson.loads(in_language(german, {"type": "state", "site_name": "Azimuth", "alarms": alarms}))
    assert told["site_name"] == "Azimuth"
    assert [one["where"] for one in told["alarms"]] == ["Site", "Anlage"]
    assert {(one["code"], one["title"], one["message"]) for one in told["alarms"]} == {
        ("drive_lost", "Azimut", "Der Antrieb von T7 antwortet nicht.")
    }


def test_how_a_zero_was_set_is_said_and_who_set_it_is_not() -> None:
    told = orjson.loads(in_language(catalogue(), {"home": {"by": "Holding", "how": "Holding"}}))
    assert told == {"home": {"by": "Holding", "how": "Steht"}}


def test_what_a_page_shows_as_text_is_sent_in_its_language() -> None:
    shown = re.compile(r'live\("([\w.]+)", "text"')
    found = [path for page in TEMPLATES.glob("*.html") for path in shown.findall(page.read_text())]
    assert len(found) > 5
    assert [path for path in found if path.split(".")[-1] not in SENTENCES] == []
