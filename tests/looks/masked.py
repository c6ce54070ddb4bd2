"""What of a page is the same in every process, on every day, and on every computer."""

import re
from functools import lru_cache

DRAWN = re.compile(r'(?<=\s)(d|points|transform|x|y|x1|x2|y1|y2|cx|cy|r|width|height)="[^"]*"')
"""Where a drawing has its lines: numbers whose last digits differ from one processor to another."""
ONCE = re.compile(r'\b(data-stop-ticket|data-csrf|data-page|data-epoch)="[^"]*"')
"""What is made anew for every session or process."""
TICKET = re.compile(r"(stop_ticket=|/sessions/|/tokens/)[\w.-]+")
HIDDEN = re.compile(r'<input type="hidden" name="(csrf|ticket|proof|page)" value="[^"]*"')
TOKEN = re.compile(r"\bhp_[\w-]+")
FILES = re.compile(r"/s/[0-9a-f]{16}/")
NUMBER = re.compile(r"\d+")


@lru_cache(maxsize=256)
def masked(html: str) -> str:
    """Return a page without what differs: tickets, the address of its files, numbers, and drawn lines."""
    html = FILES.sub("/s/", html)
    html = ONCE.sub(r'\1=""', html)
    html = TICKET.sub(r"\1", html)
    html = TOKEN.sub("hp_", html)
    html = HIDDEN.sub(r'<input type="hidden" name="\1"', html)
    html = DRAWN.sub(r'\1=""', html)
    return NUMBER.sub("0", html)
