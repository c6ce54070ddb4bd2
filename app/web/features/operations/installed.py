"""What a browser needs to put the panel on a tablet's home screen."""

from fastapi.responses import Response
from orjson import dumps
from starlette.requests import Request

from app.base.permission import Permission
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import panel

router = page_router()
COLOUR = "#f4f5f6"
ICONS = (
    ("icon-192.png", "192x192", "any"),
    ("icon-512.png", "512x512", "any"),
    ("icon-maskable-512.png", "512x512", "maskable"),
)


@router.get("/manifest.webmanifest")
@needs(Permission.OPEN)
def manifest(request: Request) -> Response:
    """Return the web app manifest."""
    url = panel(request).assets.url
    told = {
        "id": "/",
        "name": "Heliopanel",
        "short_name": "Heliopanel",
        "description": "Commissions a solar tracker and keeps it on the sun.",
        "start_url": "/",
        "scope": "/",
        "display": "standalone",
        "background_color": COLOUR,
        "theme_color": COLOUR,
        "icons": [
            {"src": url(f"img/{name}"), "sizes": sizes, "type": "image/png", "purpose": purpose}
            for name, sizes, purpose in ICONS
        ],
    }
    headers = {"Cache-Control": "no-cache"}
    return Response(dumps(told), media_type="application/manifest+json", headers=headers)
