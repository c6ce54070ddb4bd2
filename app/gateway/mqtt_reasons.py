"""The reason codes of MQTT 5 that a broker sends, each as a sentence that says what to do."""

from collections.abc import Mapping

from app.base.message import N_, Message, say

TAKEN_OVER = 142
UNSUPPORTED_VERSION = 132
_TOPIC = N_(
    "The broker at {where} does not accept the topic {base}. Set another one with HELIOPANEL_MQTT_BASE_TOPIC."
)
_FASTER_THAN_ALLOWED = N_(
    "The broker at {where} receives more messages than it allows. Set a longer "
    "HELIOPANEL_MQTT_PUBLISH_INTERVAL_S, or allow more at the broker."
)
_ELSEWHERE = N_(
    "The broker at {where} refers to another server: {server}. Set HELIOPANEL_MQTT_HOST to the right server."
)
UNNAMED_SERVER = N_("not named")

SENTENCES: Mapping[int, Message] = {
    UNSUPPORTED_VERSION: N_(
        "The broker at {where} does not support MQTT 5. Heliopanel tries MQTT 3.1.1 automatically."
    ),
    133: N_(
        "The broker at {where} does not accept the ID {client_id}. Set another one with "
        "HELIOPANEL_MQTT_CLIENT_ID."
    ),
    134: N_(
        "The broker at {where} does not accept the user name or password. Check HELIOPANEL_MQTT_USERNAME and "
        "HELIOPANEL_MQTT_PASSWORD."
    ),
    135: N_(
        "The broker at {where} does not authorize this controller. Check its user name and password, and the "
        "access rules of the broker."
    ),
    136: N_("The broker at {where} is not available. If this continues, start the broker again."),
    137: N_(
        "The broker at {where} is busy. If this continues, reduce its load, or set a longer "
        "HELIOPANEL_MQTT_PUBLISH_INTERVAL_S."
    ),
    138: N_("The broker at {where} has banned this controller. Remove the ban at the broker."),
    139: N_("The broker at {where} is shutting down. Heliopanel connects when the broker has started again."),
    140: N_(
        "The broker at {where} requires another method of authentication. Allow a user name and password, or "
        "a certificate."
    ),
    141: N_(
        "The broker at {where} received nothing for too long. Check the network between this computer and "
        "the broker."
    ),
    TAKEN_OVER: N_(
        "Another client uses the ID {client_id} at this broker. Choose another ID for this controller: set "
        "HELIOPANEL_MQTT_CLIENT_ID, and restart Heliopanel."
    ),
    143: _TOPIC,
    144: _TOPIC,
    147: N_(
        "The broker at {where} accepts fewer messages at once than Heliopanel sends. Set its receive maximum "
        "to at least 10."
    ),
    149: N_(
        "A message is too large for the broker at {where}. Allow larger messages at the broker, or set "
        "HELIOPANEL_MQTT_PAYLOAD=trackers."
    ),
    150: _FASTER_THAN_ALLOWED,
    151: N_(
        "The quota of this controller at the broker {where} is exceeded. Increase the quota, or set a longer "
        "HELIOPANEL_MQTT_PUBLISH_INTERVAL_S."
    ),
    152: N_("An administrator of the broker at {where} ended the connection. Ask the administrator why."),
    154: N_(
        "The broker at {where} does not support retained messages. Allow retained messages, or use another "
        "broker."
    ),
    155: N_("The broker at {where} does not support QoS 1. Allow QoS 1, or use another broker."),
    156: _ELSEWHERE,
    157: _ELSEWHERE,
    159: N_(
        "The broker at {where} receives too many new connections. Increase its connection rate; Heliopanel "
        "connects less often."
    ),
    160: N_(
        "The broker at {where} limits the time of a connection. Heliopanel connects again automatically."
    ),
    162: N_(
        "The broker at {where} does not allow subscriptions with wildcards. Allow wildcards, or set "
        "HELIOPANEL_MQTT_COMMANDS=false."
    ),
}
_UNEXPLAINED = N_(
    "The broker at {where} reports the MQTT reason code {code}. Look for the cause in the log of the broker."
)


def told_reason(code: int, *, where: str, client_id: str, base: str, server: str) -> Message:
    """Return what a broker's reason code says to the user of this controller."""
    named = server or UNNAMED_SERVER
    sentence = str(SENTENCES.get(code, _UNEXPLAINED))
    return say(sentence, where=where, client_id=client_id, base=base, server=named, code=code)
