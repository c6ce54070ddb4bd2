"""Routes that are worked out with their first request: most of the 300 are never called in one run."""

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import APIRouter
from fastapi.routing import APIRoute
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import compile_path, get_name

from app.web.http.whole_forms import field_names, refuse_incomplete

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class LateRoute(APIRoute):
    """A route that knows at first what it takes; what checks and writes it follows within milliseconds.

    All of them at the start took a third of it, and a sixth of the panel's memory.
    """

    def __init__(self, path: str, endpoint: Callable[..., Any], **told: Any) -> None:
        self._told = told
        self.path, self.endpoint = path, endpoint
        self.name = told["name"] or get_name(endpoint)
        self.methods = {method.upper() for method in told["methods"]}
        self.path_regex, self.path_format, self.param_convertors = compile_path(path)

    def __getattr__(self, name: str) -> Any:
        """Work the route out when something is asked that it does not have yet."""
        if "_told" not in self.__dict__:
            raise AttributeError(name)
        self.work_out()
        return getattr(self, name)

    def work_out(self) -> None:
        """Do now what would wait for the first request."""
        super().__init__(self.path, self.endpoint, **self.__dict__.pop("_told"))


class PageRoute(LateRoute):
    """A route of a page: a form that lacks one of its fields is refused before anything is read of it."""

    def get_route_handler(self) -> Handler:
        """Return what answers a request."""
        handle, names = super().get_route_handler(), field_names(self.endpoint)
        if not names:
            return handle

        async def handle_whole(request: Request) -> Response:
            refuse_incomplete(await request.form(), names)
            return await handle(request)

        return handle_whole


def page_router(prefix: str = "") -> APIRouter:
    """Return a router of pages; the document tells of the API alone."""
    return APIRouter(prefix=prefix, route_class=PageRoute, include_in_schema=False)
