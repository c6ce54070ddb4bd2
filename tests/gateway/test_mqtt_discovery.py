"""Base topics of the world: ids that Home Assistant accepts, one for each, or a refusal in a sentence."""

import json
import re
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from pydantic import ValidationError

from app.base.settings import Settings, SettingsWrong, read_settings
from app.gateway.mqtt_discovery import announcements, node_id
from app.gateway.mqtt_messages import Topics
from tests.golden.table import rows
from tests.site.plant import make_plant

ROWS = rows("world/base_topics.csv")
RIGHT = [row for row in ROWS if not row["refusal"]]
REFUSED = [row for row in ROWS if row["refusal"]]
ALLOWED = re.compile(r"[A-Za-z0-9_-]+")


@pytest.mark.parametrize("row", RIGHT, ids=lambda row: row["why"])
def test_the_id_of_a_tracker_has_only_what_home_assistant_allows(row: dict[str, str]) -> None:
    base = Settings(mqtt_base_topic=row["text"]).mqtt_base_topic
    node = node_id(base, "T1")
    assert ALLOWED.fullmatch(node)
    if base.isascii():
        assert node == row["node"], "an id that is in use is never changed"
    elif row["node"]:
        assert re.fullmatch(re.escape(row["node"]) + "[0-9a-f]{16}", node)


def test_no_two_trackers_have_one_id() -> None:
    pairs = list(product((row["text"] for row in RIGHT), ("T1", "T2", "T1_2", "T1-2")))
    assert len({node_id(*pair) for pair in pairs}) == len(pairs)
    assert node_id("saha/güneş", "T1") == "saha_g_ne__T1_c278252d02ba2d8e", "after every start"


@pytest.mark.parametrize("row", REFUSED, ids=lambda row: row["why"])
def test_a_topic_that_no_broker_takes_is_refused_in_a_sentence(
    row: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "heliopanel.toml"
    file.write_text(f"mqtt_base_topic = {json.dumps(row['text'])}\n")
    monkeypatch.setenv("HELIOPANEL_CONFIG", str(file))
    with pytest.raises(SettingsWrong) as caught:
        read_settings()
    told = str(caught.value)
    assert told.startswith("HELIOPANEL_MQTT_BASE_TOPIC ")
    assert row["refusal"] in told
    assert told.isprintable()
    assert len(told) < 300


@pytest.mark.parametrize("name", ["mqtt_base_topic", "mqtt_client_id", "mqtt_username"])
def test_what_a_broker_reads_has_no_hidden_characters(name: str) -> None:
    for text in ("helio\x00panel", "\ufeffheliopanel"):
        with pytest.raises(ValidationError, match=f"HELIOPANEL_{name.upper()} is .*not visible"):
            Settings.model_validate({name: text})
    assert Settings.model_validate({name: "Çiftlik_1"})


async def test_names_and_units_keep_their_letters_and_buttons_are_for_who_may_command() -> None:
    plant = make_plant()
    await plant.start()
    tracker = replace(plant.tracker(), name="Güneş 太阳")
    await plant.close()
    topics = Topics("saha/güneş")
    told = announcements(topics, [tracker], commands=True)
    assert (len(told), len(announcements(topics, [tracker], commands=False))) == (8, 5)
    for topic, payload in told.items():
        prefix, component, node, name, config = topic.split("/")
        assert (prefix, config) == ("homeassistant", "config")
        assert ALLOWED.fullmatch(component + node + name)
        values = json.loads(payload)
        assert ALLOWED.fullmatch(values["unique_id"])
        assert values["device"]["name"] == "T1 Güneş 太阳"
        assert values["availability_topic"] == "saha/güneş/availability"
        assert values.get("unit_of_measurement", "°") == "°"
