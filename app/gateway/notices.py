"""What is sent about an alarm by webhook and by e-mail, and how: plain blocking calls with a time limit."""

import hashlib
import hmac
import http.client
import smtplib
import ssl
from collections.abc import Mapping
from dataclasses import asdict
from email.message import EmailMessage
from urllib.parse import urlsplit

import orjson

from app.base.message import N_, say, told_by
from app.base.settings import Settings
from app.store.store import JournalEntry
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.notifications import Notifications

WITHIN_S = 5.0
SIGNATURE = "X-Heliopanel-Signature"
DELIVERY = "X-Heliopanel-Delivery"
LONGEST_ANSWER = 65536


class NotDelivered(Exception):
    """A message did not arrive; the text says why and what to do."""


def post_webhook(settings: Settings, wanted: Notifications, series: str, entry: JournalEntry) -> None:
    """Post one alarm as JSON, or raise `NotDelivered`; only an answer from 200 to 299 counts as arrived."""
    body = orjson.dumps({"series": series, "sequence": entry.number, **asdict(entry.event)}, default=str)
    headers = {
        "Content-Type": "application/json",
        "User-Agent": "Heliopanel",
        DELIVERY: f"{series}-{entry.number}",
    }
    if settings.webhook_secret is not None:
        headers[SIGNATURE] = signature(settings.webhook_secret.get_secret_value(), body)
    status = _post(wanted.webhook_url, body, headers)
    if not 200 <= status < 300:
        raise NotDelivered(
            say(
                "The webhook answered {status}; it must answer with 200 to 299. Check its address.",
                status=status,
            )
        )


def signature(secret: str, body: bytes) -> str:
    """Return what the header says: HMAC-SHA256 of the body, so that the receiver knows who sent it."""
    return f"sha256={hmac.new(secret.encode(), body, hashlib.sha256).hexdigest()}"


def _post(url: str, body: bytes, headers: Mapping[str, str]) -> int:
    """Return the status of the answer; redirections are not followed."""
    try:
        parts = urlsplit(url)
        host, port = parts.hostname or "", parts.port
        secure = parts.scheme == "https"
        kind = http.client.HTTPSConnection if secure else http.client.HTTPConnection
        connection = kind(host, port, timeout=WITHIN_S)
    except (ValueError, http.client.HTTPException) as error:
        raise NotDelivered(
            say("The webhook's address is wrong: {error}. Correct it on the Site page.", error=told_by(error))
        ) from error
    path = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
    try:
        connection.request("POST", path, body, dict(headers))
        answer = connection.getresponse()
        answer.read(LONGEST_ANSWER)
    except (OSError, ValueError, http.client.HTTPException) as error:
        raise NotDelivered(
            say(
                "The webhook at {host} cannot be reached: {error}. Check its address and the network.",
                host=host,
                error=told_by(error),
            )
        ) from error
    finally:
        connection.close()
    return answer.status


def send_mail(settings: Settings, wanted: Notifications, series: str, entry: JournalEntry) -> None:
    """Send one alarm by e-mail, or raise `NotDelivered`."""
    if settings.smtp_host is None:
        raise NotDelivered(
            N_("No mail server is set. Set HELIOPANEL_SMTP_HOST and restart, or remove the addresses.")
        )
    message = mail(settings, wanted, series, entry)
    try:
        with _mail_server(settings, settings.smtp_host) as server:
            if settings.smtp_username is not None:
                password = settings.smtp_password
                server.login(settings.smtp_username, "" if password is None else password.get_secret_value())
            server.send_message(message)
    except (OSError, ValueError, smtplib.SMTPException) as error:
        raise NotDelivered(
            say(
                "The mail server {smtp_host} did not accept the message: {error}. Check the server "
                "and the addresses.",
                smtp_host=settings.smtp_host,
                error=told_by(error),
            )
        ) from error


def _mail_server(settings: Settings, host: str) -> smtplib.SMTP:
    """Return a connection to the mail server, encrypted as the settings say."""
    port = settings.smtp_port or {"none": 25, "starttls": 587, "tls": 465}[settings.smtp_tls]
    trust = ssl.create_default_context()
    if settings.smtp_tls == "tls":
        return smtplib.SMTP_SSL(host, port, timeout=WITHIN_S, context=trust)
    server = smtplib.SMTP(host, port, timeout=WITHIN_S)
    if settings.smtp_tls == "starttls":
        try:
            server.starttls(context=trust)
        except BaseException:
            server.close()
            raise
    return server


def mail(settings: Settings, wanted: Notifications, series: str, entry: JournalEntry) -> EmailMessage:
    """Return the message; the same entry has the same id, so that a repeated one is known as such."""
    event = entry.event
    message = EmailMessage()
    message["From"] = settings.smtp_from
    message["To"] = ", ".join(wanted.mail_to)
    message["Subject"] = " ".join(subject(event).split())[:200]
    message["Date"] = event.at
    message["Message-ID"] = f"<{series}-{entry.number}@heliopanel.invalid>"
    message.set_content(text(event))
    return message


def subject(event: Event) -> str:
    """Return what an e-mail is about, the priority first."""
    data = event.data
    if event.kind is EventKind.NOTIFICATION_TESTED:
        return N_("Heliopanel: test message")
    over = "over: " if event.kind is EventKind.ALARM_RETURNED else ""
    return f"[P{data['priority']}] {over}{data['title']}, {data['where']}"


def text(event: Event) -> str:
    """Return what an e-mail says: what, where, since, what to do."""
    data = event.data
    if event.kind is EventKind.NOTIFICATION_TESTED:
        return f"This is a test. {event.actor} asked for it at {event.at:%Y-%m-%d %H:%M:%S} UTC.\n"
    lines = (
        event.message,
        "",
        say("Where: {data}", data=data["where"]),
        say("Since: {data}", data=data["since"]),
        f"Do:    {data['do']}",
        "",
        N_("Acknowledge the alarm in Heliopanel, on the Alarms page."),
    )
    return "\n".join(lines) + "\n"
