"""What every route needs, by method and path; a route that is not here keeps the panel from starting.

To add a route: write it below the permission that it needs, and into `PROVEN` if it changes users, tokens,
drives, limits or network settings, for which the password is asked for again. Where limits or the drive are
part of a larger form, `app/web/limit_review.py` asks.
"""

from app.access.roles import Permission

_TABLE: dict[Permission, str] = {
    Permission.OPEN: """
        GET /certificate
        GET /certificate/ca.crt
        GET /api/v1/certificate
        GET /manifest.webmanifest
        GET /login
        POST /login
        GET /setup
        POST /setup
        GET /network/trial
        POST /network/trial
        POST /api/v1/network/confirmation
        GET /kiosk
        POST /kiosk
        POST /theme
        POST /language
        GET /health
        GET /ready
        GET /api/v1/health
        GET /api/v1/ready
        POST /api/v1/session
    """,
    Permission.STOP: """
        POST /stop
        POST /trackers/{tracker_id}/stop
        POST /trackers/{tracker_id}/end-jog
        POST /api/v1/stop
        POST /api/v1/trackers/{tracker_id}/stop
        DELETE /api/v1/trackers/{tracker_id}/jog/{press_id}
        WS /live
    """,
    Permission.OWN: """
        GET /account
        POST /account/password
        POST /account/sessions/{digest}/end
        GET /prove
        POST /prove
        POST /logout
        POST /kiosk/pin
        PUT /api/v1/me/password
        DELETE /api/v1/session
        POST /api/v1/session/proof
    """,
    Permission.READ: """
        GET /
        GET /accuracy
        GET /alarms
        GET /site/notifications
        GET /api/v1/site/notifications
        GET /alarms/guide
        GET /guide
        GET /guide/pictures/{name}
        GET /guide/{document}
        GET /search
        GET /journal
        GET /metrics
        GET /papers
        GET /records
        GET /records/compare
        GET /records/{number}
        GET /recordings
        GET /recordings/{recording_id}
        GET /simulate
        GET /site
        GET /site/horizon
        GET /studies
        GET /studies/glance
        GET /studies/list
        GET /studies/program
        GET /studies/{study_id}
        GET /studies/{study_id}/curves.csv
        GET /studies/{study_id}/table.csv
        GET /trackers/{tracker_id}
        GET /trackers/{tracker_id}/commissioning
        GET /trackers/{tracker_id}/commissioning/clock
        GET /trackers/{tracker_id}/commissioning/homing
        GET /trackers/{tracker_id}/commissioning/location
        GET /trackers/{tracker_id}/commissioning/location/preview
        GET /trackers/{tracker_id}/commissioning/mode
        GET /trackers/{tracker_id}/commissioning/mode/orientation
        POST /trackers/{tracker_id}/commissioning/mode/orientation
        GET /trackers/{tracker_id}/commissioning/progress/{step}
        GET /trackers/{tracker_id}/commissioning/run
        GET /trackers/{tracker_id}/drive
        GET /trackers/{tracker_id}/machine
        POST /trackers/{tracker_id}/machine/picture
        GET /trackers/{tracker_id}/mount
        POST /trackers/{tracker_id}/mount/kind
        GET /trackers/{tracker_id}/proofs
        GET /trackers/{tracker_id}/training
        GET /trackers/{tracker_id}/record
        GET /trackers/{tracker_id}/record/photos/{number}.jpg
        GET /trackers/{tracker_id}/label
        GET /trackers/{tracker_id}/protections
        GET /trackers/{tracker_id}/service
        GET /trackers/{tracker_id}/settings
        GET /trackers/{tracker_id}/show
        GET /trackers/{tracker_id}/shows/{show_id}
        GET /trackers/{tracker_id}/strategy
        GET /trackers/{tracker_id}/strategy/day
        GET /trackers/{tracker_id}/strategy/program.csv
        GET /trackers/{tracker_id}/sun-check
        GET /trackers/{tracker_id}/sun-path
        GET /trackers/{tracker_id}/trends
        GET /api/v1/openapi.json
        GET /api/v1/me
        POST /api/v1/tickets
        GET /api/v1/alarms
        GET /api/v1/alarms/catalogue
        GET /api/v1/alarms/history
        GET /api/v1/journal
        GET /api/v1/journal/export
        GET /api/v1/mechanisms
        GET /api/v1/metrics
        GET /api/v1/mounts
        GET /api/v1/papers
        GET /api/v1/records
        GET /api/v1/records/{number}
        GET /api/v1/records/{number}/photos
        GET /api/v1/records-comparison
        GET /api/v1/record-photos/{number}
        GET /api/v1/trackers/{tracker_id}/record/photos
        GET /api/v1/recordings
        GET /api/v1/recordings/{recording_id}
        GET /api/v1/recordings/{recording_id}/frames
        GET /api/v1/site
        GET /api/v1/site/clock
        GET /api/v1/site/horizon
        GET /api/v1/site/integrations
        GET /api/v1/site/weather
        GET /api/v1/site/weather/simulation
        GET /api/v1/site/weather/station
        GET /api/v1/site/weather/windows
        GET /api/v1/stream
        GET /api/v1/studies
        GET /api/v1/studies-comparison
        GET /api/v1/studies/{study_id}
        GET /api/v1/sun
        GET /api/v1/sun/accuracy
        GET /api/v1/sun/algorithms
        GET /api/v1/sun/day
        GET /api/v1/telemetry
        GET /api/v1/trackers
        GET /api/v1/trackers/{tracker_id}
        GET /api/v1/trackers/{tracker_id}/actions
        GET /api/v1/trackers/{tracker_id}/capabilities
        GET /api/v1/trackers/{tracker_id}/commissioning
        GET /api/v1/trackers/{tracker_id}/control
        GET /api/v1/trackers/{tracker_id}/settings-lock
        GET /api/v1/trackers/{tracker_id}/drive/check
        GET /api/v1/trackers/{tracker_id}/drive/choices
        GET /api/v1/trackers/{tracker_id}/mount
        GET /api/v1/trackers/{tracker_id}/program
        GET /api/v1/trackers/{tracker_id}/program/examples
        GET /api/v1/trackers/{tracker_id}/proofs
        GET /api/v1/trackers/{tracker_id}/training
        GET /api/v1/trackers/{tracker_id}/record
        GET /api/v1/trackers/{tracker_id}/shows/{show_id}
        GET /api/v1/trackers/{tracker_id}/sightings
        GET /api/v1/trackers/{tracker_id}/snapshot
        POST /api/v1/trackers/{tracker_id}/review
        POST /api/v1/trackers/{tracker_id}/strategy/day
        GET /api/v1/weather-files
    """,
    Permission.REPORT: """
        PUT /api/v1/site/weather
    """,
    Permission.SIMULATE: """
        POST /simulate
        POST /studies
        POST /studies/weather
        POST /studies/weather/{name}/delete
        POST /studies/{study_id}/remove
        POST /api/v1/recordings/{recording_id}/rerun
        POST /api/v1/simulations
        POST /api/v1/studies
        POST /api/v1/studies/programs
        DELETE /api/v1/studies/{study_id}
        POST /api/v1/weather-files
        DELETE /api/v1/weather-files/{name}
    """,
    Permission.OPERATE: """
        POST /trackers/{tracker_id}/control
        POST /alarms/acknowledge
        POST /alarms/shelve
        POST /alarms/unshelve
        POST /api/v1/alarms/{alarm_id}/acknowledge
        POST /api/v1/alarms/{alarm_id}/shelve
        POST /api/v1/alarms/{alarm_id}/unshelve
        POST /trackers/{tracker_id}/move
        POST /trackers/{tracker_id}/lock
        POST /trackers/{tracker_id}/park
        POST /trackers/{tracker_id}/release-lock
        POST /trackers/{tracker_id}/resume
        POST /trackers/{tracker_id}/service
        POST /trackers/{tracker_id}/service/clear
        POST /trackers/{tracker_id}/service/end
        POST /trackers/{tracker_id}/stow
        POST /trackers/{tracker_id}/reset-fault
        POST /trackers/{tracker_id}/step
        POST /trackers/{tracker_id}/track
        POST /trackers/{tracker_id}/commissioning/mode
        POST /trackers/{tracker_id}/show/go-to-start
        POST /trackers/{tracker_id}/show/pause
        POST /trackers/{tracker_id}/show/resume
        POST /trackers/{tracker_id}/show/run
        POST /trackers/{tracker_id}/show/stop
        POST /api/v1/control
        POST /api/v1/trackers/{tracker_id}/commands
        POST /api/v1/trackers/{tracker_id}/control
        DELETE /api/v1/trackers/{tracker_id}/control
        POST /api/v1/trackers/{tracker_id}/jog
        POST /api/v1/trackers/{tracker_id}/shows
        POST /api/v1/trackers/{tracker_id}/shows/{show_id}/{action}
    """,
    Permission.CONFIGURE: """
        GET /components
        POST /recordings/{recording_id}/delete
        POST /site/horizon
        POST /site/name
        POST /site/notifications
        POST /site/notifications/test
        PUT /api/v1/site/notifications
        POST /api/v1/site/notifications/{channel}/test
        POST /site/undo
        POST /api/v1/site/undo
        POST /site/simulated-weather
        POST /site/simulated-weather/end
        POST /site/weather-station
        POST /site/weather-windows
        PUT /api/v1/site/weather/simulation
        DELETE /api/v1/site/weather/simulation
        PUT /api/v1/site/weather/windows
        PUT /api/v1/site/weather/station
        DELETE /api/v1/site/weather/station
        POST /studies/program/use
        POST /trackers
        POST /trackers/{tracker_id}/commissioning/clock
        POST /trackers/{tracker_id}/commissioning/clock/device
        POST /trackers/{tracker_id}/commissioning/clock/system
        POST /trackers/{tracker_id}/commissioning/location
        POST /trackers/{tracker_id}/commissioning/{step}/confirm
        POST /trackers/{tracker_id}/drive
        POST /trackers/{tracker_id}/drive/restore
        POST /trackers/{tracker_id}/drive/test
        POST /trackers/{tracker_id}/home
        POST /trackers/{tracker_id}/machine
        POST /trackers/{tracker_id}/mount
        POST /trackers/{tracker_id}/proofs/direction
        POST /trackers/{tracker_id}/proofs/direction/answer
        POST /trackers/{tracker_id}/proofs/limit
        POST /trackers/{tracker_id}/proofs/link-loss
        POST /trackers/{tracker_id}/proofs/scale
        POST /trackers/{tracker_id}/proofs/scale/answer
        POST /trackers/{tracker_id}/proofs/stop
        POST /trackers/{tracker_id}/record
        POST /trackers/{tracker_id}/record/photos
        POST /trackers/{tracker_id}/record/photos/{number}/remove
        POST /trackers/{tracker_id}/training/clear
        POST /trackers/{tracker_id}/training/play
        POST /trackers/{tracker_id}/training/weather
        POST /trackers/{tracker_id}/protections
        POST /trackers/{tracker_id}/settings
        POST /trackers/{tracker_id}/settings-lock
        POST /trackers/{tracker_id}/settings-lock/open
        POST /trackers/{tracker_id}/settings/remove
        POST /trackers/{tracker_id}/settings/undo
        POST /trackers/{tracker_id}/strategy
        POST /trackers/{tracker_id}/strategy/hybrid
        POST /trackers/{tracker_id}/strategy/program
        POST /trackers/{tracker_id}/sun-check/apply
        POST /trackers/{tracker_id}/sun-check/forget
        POST /trackers/{tracker_id}/sun-check/take
        POST /trackers/{tracker_id}/zero
        DELETE /api/v1/recordings/{recording_id}
        PATCH /api/v1/site
        PUT /api/v1/site/clock
        PUT /api/v1/site/horizon
        PUT /api/v1/site/location
        POST /api/v1/trackers
        DELETE /api/v1/trackers/{tracker_id}
        PATCH /api/v1/trackers/{tracker_id}
        POST /api/v1/trackers/{tracker_id}/commissioning/{step}/confirm
        POST /api/v1/trackers/{tracker_id}/drive/check
        POST /api/v1/trackers/{tracker_id}/drive/restore
        PUT /api/v1/trackers/{tracker_id}/program
        PUT /api/v1/trackers/{tracker_id}/settings-lock
        POST /api/v1/trackers/{tracker_id}/undo
        PUT /api/v1/trackers/{tracker_id}/program.csv
        POST /api/v1/trackers/{tracker_id}/proofs/direction
        POST /api/v1/trackers/{tracker_id}/records
        POST /api/v1/trackers/{tracker_id}/record/photos
        DELETE /api/v1/trackers/{tracker_id}/record/photos/{number}
        DELETE /api/v1/trackers/{tracker_id}/training
        POST /api/v1/trackers/{tracker_id}/training
        POST /api/v1/trackers/{tracker_id}/proofs/limits
        POST /api/v1/trackers/{tracker_id}/proofs/scale
        POST /api/v1/trackers/{tracker_id}/sightings
        PUT /api/v1/trackers/{tracker_id}/sightings
    """,
    Permission.ADMINISTER: """
        GET /audit
        GET /audit/access
        GET /api/v1/audit
        GET /api/v1/audit/access
        GET /network
        POST /network
        GET /api/v1/network
        PUT /api/v1/network
        GET /backup
        POST /backup
        GET /restore
        POST /restore
        GET /diagnostics.zip
        GET /users
        POST /users
        POST /users/{name}/roles
        POST /users/{name}/password
        POST /users/{name}/remove
        POST /users/sessions/{digest}/end
        GET /tokens
        POST /tokens
        POST /tokens/{token_id}/revoke
        GET /api/v1/backup
        POST /api/v1/backup
        GET /api/v1/backups
        POST /api/v1/restore
        GET /api/v1/diagnostics.zip
        GET /api/v1/users
        POST /api/v1/users
        PATCH /api/v1/users/{name}
        DELETE /api/v1/users/{name}
        GET /api/v1/sessions
        DELETE /api/v1/sessions/{digest}
        GET /api/v1/tokens
        POST /api/v1/tokens
        DELETE /api/v1/tokens/{token_id}
    """,
}

ROUTES: dict[str, Permission] = {
    line.strip(): permission
    for permission, lines in _TABLE.items()
    for line in lines.split("\n")
    if line.strip()
}
"""Permission by method and path, such as `POST /stop`; `WS` stands for a WebSocket."""

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
    POST /backup
    POST /restore
    POST /api/v1/restore
    POST /api/v1/users
    PATCH /api/v1/users/{name}
    DELETE /api/v1/users/{name}
    POST /api/v1/tokens
    POST /api/v1/trackers/{tracker_id}/drive/restore
    POST /api/v1/trackers/{tracker_id}/undo
    POST /api/v1/backup
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
