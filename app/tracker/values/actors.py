"""Who did something, where nobody ordered it."""

CONTROLLER = "controller"
"""The controller itself; no user may have this name."""
LOCAL_USER = "local user"
"""Who sits at the controller's computer while there are no users; told in the reader's language."""
FORMERLY = "machine"
"""What former versions wrote for it."""


def actor_of(stored: str) -> str:
    """Return who is meant by a stored name."""
    return CONTROLLER if stored == FORMERLY else stored


def names_of(actor: str) -> tuple[str, ...]:
    """Return every name under which somebody has been stored."""
    return (CONTROLLER, FORMERLY) if actor == CONTROLLER else (actor,)
