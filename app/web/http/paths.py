"""Ways to the pages where one signs in, and back."""

from urllib.parse import quote


def own_path(path: str) -> str:
    """Return the path if it belongs to this panel, else the overview."""
    safe = path.startswith("/") and not path.startswith(("//", "/\\")) and path.isprintable()
    return path if safe else "/"


def login_path(back: str) -> str:
    """Return the way to the log-in page that leads back here."""
    return f"/login?back={quote(own_path(back), safe='/')}"


def proof_path(back: str) -> str:
    """Return the way to the page that asks for the password again and leads back here."""
    return f"/prove?back={quote(own_path(back), safe='/')}"
