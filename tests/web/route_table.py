"""What every route of the panel needs, as collected from the routes themselves."""

from app.web.http.routes import table
from tests.fakes import fake_app

NEEDS = table(fake_app().state.routes)
ROUTES = {key: need.permission for key, need in NEEDS.items()}
