"""Who is told of alarms besides those at the screen: by webhook and by e-mail, which priorities."""

from dataclasses import dataclass
from enum import StrEnum

from app.base.message import N_, say

MOST_ADDRESSES = 10


class Channel(StrEnum):
    """The ways by which alarms are sent; MQTT always tells them all."""

    WEBHOOK = "webhook"
    MAIL = "mail"


@dataclass(frozen=True, slots=True)
class Notifications:
    """Where alarms of which priorities are sent; an empty address: nowhere.

    Raises `ValueError` with a sentence for an address that cannot be one.
    """

    webhook_url: str = ""
    webhook_priorities: tuple[int, ...] = (1, 2)
    mail_to: tuple[str, ...] = ()
    mail_priorities: tuple[int, ...] = (1, 2)

    def __post_init__(self) -> None:
        if self.webhook_url and not self.webhook_url.startswith(("http://", "https://")):
            raise ValueError(
                say(
                    "{webhook_url} is not a web address: it must begin with https or http.",
                    webhook_url=repr(self.webhook_url),
                )
            )
        if len(self.webhook_url) > 500 or any(one.isspace() for one in self.webhook_url):
            raise ValueError(N_("A web address has at most 500 characters and no spaces."))
        if len(self.mail_to) > MOST_ADDRESSES:
            raise ValueError(
                say(
                    "Mail goes to at most {most_addresses} addresses; use a mailing list.",
                    most_addresses=MOST_ADDRESSES,
                )
            )
        for address in self.mail_to:
            name, _, host = address.partition("@")
            if not name or not host or any(one.isspace() or one in ",;<>" for one in address):
                raise ValueError(
                    say("{address} is not a mail address such as name@example.org.", address=repr(address))
                )
        if not {*self.webhook_priorities, *self.mail_priorities} <= {1, 2, 3, 4}:
            raise ValueError(N_("Priorities are 1, 2, 3 and 4."))

    def reaches(self, channel: Channel) -> bool:
        """Return whether a channel has an address."""
        return bool(self.webhook_url if channel is Channel.WEBHOOK else self.mail_to)

    def priorities(self, channel: Channel) -> tuple[int, ...]:
        """Return which priorities a channel is told."""
        return self.webhook_priorities if channel is Channel.WEBHOOK else self.mail_priorities
