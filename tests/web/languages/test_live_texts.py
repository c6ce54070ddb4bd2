"""What a page is sent while it stands: its sentences in another language, names and codes as they are."""

import orjson

from app.base.message import N_, say
from app.web.languages.live_texts import in_language
from tests.web.languages.made_up import GERMAN, catalogue

ALARM = {
    "code": "drive_lost",
    "title": N_("Azimuth"),
    "message": say("The drive of {name} does not answer.", name="T7"),
}


def test_sentences_are_said_and_names_are_not() -> None:
    german = catalogue(GERMAN | {"Site": "Anlage"})
    alarms = [{**ALARM, "where": say("{name}", name="Site")}, {**ALARM, "where": N_("Site")}]
    told = orjson.loads(in_language(german, {"type": "state", "site_name": "Azimuth", "alarms": alarms}))
    assert told["site_name"] == "Azimuth"
    assert [one["where"] for one in told["alarms"]] == ["Site", "Anlage"]
    assert {(one["code"], one["title"], one["message"]) for one in told["alarms"]} == {
        ("drive_lost", "Azimut", "Der Antrieb von T7 antwortet nicht.")
    }


def test_a_message_that_is_not_translated_stays_english() -> None:
    told = orjson.loads(
        in_language(catalogue(), {"strip": [N_("Said in no catalogue."), say("{a}!", a="Row 6")]})
    )
    assert told == {"strip": ["Said in no catalogue.", "Row 6!"]}
