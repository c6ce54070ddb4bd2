"""The topics, IDs, and user names of MQTT that people type: one check, each fault in a sentence."""

import unicodedata

LONGEST_TOPIC = 100
LONGEST_SHOWN = 60
CONTROLS = ("Cc", "Cs")
BYTE_ORDER_MARK = "\ufeff"


def checked_topic(variable: str, topic: str) -> str:
    """Return the first levels of a topic as they are, or raise `ValueError` with a sentence."""
    checked_name(variable, topic)
    if not topic:
        raise ValueError(f"{variable} is empty. Enter a topic such as plant/north, or remove the setting.")
    if "+" in topic or "#" in topic:
        raise ValueError(_wrong(variable, topic, "+ and # are wildcards of MQTT. Remove them."))
    if any(letter.isspace() for letter in topic):
        raise ValueError(
            _wrong(variable, topic, "A topic has no spaces here. Replace them, for example with _.")
        )
    if topic.startswith("/") or topic.endswith("/"):
        raise ValueError(_wrong(variable, topic, "A topic has no slash at its ends here. Remove it."))
    if len(topic) > LONGEST_TOPIC:
        raise ValueError(
            _wrong(variable, topic, f"It has {len(topic)} letters; enter at most {LONGEST_TOPIC}.")
        )
    return topic


def checked_name(variable: str, name: str) -> str:
    """Return a text of MQTT as it is, or raise `ValueError` where no broker would accept it."""
    if any(unicodedata.category(letter) in CONTROLS or letter == BYTE_ORDER_MARK for letter in name):
        raise ValueError(
            _wrong(variable, name, "It has characters that are not visible. Enter it again by hand.")
        )
    return name


def _wrong(variable: str, given: str, advice: str) -> str:
    shown = "".join(letter if letter.isprintable() else _escaped(letter) for letter in given[:LONGEST_SHOWN])
    return f"{variable} is '{shown}'. {advice}"


def _escaped(letter: str) -> str:
    return letter.encode("unicode_escape").decode("ascii")
