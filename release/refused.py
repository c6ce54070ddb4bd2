"""Why a release cannot be made."""


class Refused(Exception):
    """A release cannot be made; the text says what to do."""
