"""Routes that need more than a permission: the password typed again, an end when one must leave, a ticket.

A route that changes users, tokens, drives, limits or network settings stands in `PROVEN`. Where limits or
the drive are part of a larger form, `app/web/limit_review.py` asks.
"""

PROVEN = frozenset(
    """
    POST /users
    POST /users/{name}/roles
    POST /users/{name}/password
    POST /users/{name}/remove
    POST /tokens
    GET /network
    POST /network
    PUT /api/v1/network
    POST /trackers/{tracker_id}/drive
    POST /trackers/{tracker_id}/drive/restore
    POST /trackers/{tracker_id}/mount/kind
    POST /trackers/{tracker_id}/settings/undo
    POST /restore
    POST /api/v1/backups/{name}/restore
    POST /api/v1/users
    PATCH /api/v1/users/{name}
    DELETE /api/v1/users/{name}
    POST /api/v1/tokens
    POST /api/v1/trackers/{tracker_id}/drive/restore
    POST /api/v1/trackers/{tracker_id}/undo
    POST /api/v1/backups
    """.strip()
    .replace("    ", "")
    .split("\n")
)
"""What a session may do only within 5 minutes of typing the password."""

STREAMS = frozenset({"WS /live", "GET /api/v1/stream"})
"""What lasts: it ends within a second when who asked for it must leave."""

TICKETED = STREAMS | {
    "GET /api/v1/journal/export",
    "GET /diagnostics.zip",
    "GET /api/v1/diagnostics.zip",
    "GET /api/v1/recordings/{recording_id}/frames",
    "GET /api/v1/records/{number}",
    "GET /api/v1/record-photos/{number}",
    "GET /studies/{study_id}/curves.csv",
    "GET /studies/{study_id}/table.csv",
}
"""What a one-shot ticket opens: streams and downloads, for which a program cannot send a header."""
