"""What the exceptions of Modbus mean, and what follows from them."""

from app.base.message import N_, join, say
from app.modbus.errors import DriveError, DriveRefused, DriveSilent

EXCEPTIONS = {
    1: N_("does not support this function"),
    2: N_("has no such register"),
    3: N_("does not accept this value"),
    4: N_("reports an internal failure"),
    5: N_("needs more time"),
    6: N_("is busy"),
    10: N_("cannot be reached through its gateway"),
    11: N_("does not answer its gateway"),
}
PERMANENT = (1, 2, 3)
UNREACHABLE = (10, 11)
FITS, AGAIN = N_("Check that the profile fits the device."), N_("The request is repeated in the next cycle.")


def refusal(code: int, unit: object, what: str) -> DriveError:
    """Return what is said of a request for `what` that a device answered with an exception."""
    text = EXCEPTIONS.get(code, N_("answered with an unknown exception"))
    sentence = say(
        "The drive at {unit} {text} (Modbus exception {code}): {what}.",
        unit=unit,
        text=text,
        code=code,
        what=what,
    )
    if code in PERMANENT:
        return DriveRefused(join(" ", (sentence, FITS)))
    if code in UNREACHABLE:
        return DriveSilent(sentence)
    return DriveError(join(" ", (sentence, AGAIN)))
