"""What each process loads before it serves: what is needed seldom stays out of its memory and its start."""

import subprocess
import sys
from pathlib import Path

import pytest

SELDOM = {"PIL", "alembic", "babel", "cryptography", "fpdf", "mako", "pandas", "pvlib", "pyarrow", "segno"}
COMMAND_LINE = {"pygments", "rich", "shellingham", "structlog", "typer"}
OF_THE_PANEL = {"argon2", "fastapi", "jinja2", "markdown_it", "starlette", "tzfpy", "uvicorn", "websockets"}
FOR_A_REQUEST = {"markdown_it", "prometheus_client"}
OF_THE_CONTROLLER = {"aiomqtt", "paho", "pymodbus", "serial", "app.drives", "app.gateway", "app.site"}
WORKED_OUT_ELSEWHERE = {
    "app.research.gezegin",
    "app.show.simulate",
    "app.studies.compute",
    "numpy.fft",
    "numpy.polynomial",
    "numpy.random",
}


def ran(code: str) -> list[set[str]]:
    """Return the words of each line that a new process prints."""
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return [set(line.split()) for line in told.stdout.splitlines()]


@pytest.mark.parametrize(
    ("module", "not_needed"),
    [
        (
            "app.machine.supervisor",
            {*SELDOM, *COMMAND_LINE, *OF_THE_PANEL, "numpy", "pydantic", "sqlalchemy"},
        ),
        ("app.machine.main", {*SELDOM, *COMMAND_LINE, *OF_THE_PANEL, *WORKED_OUT_ELSEWHERE, "app.web"}),
    ],
)
def test_a_process_loads_only_what_it_needs_all_the_time(module: str, not_needed: set[str]) -> None:
    (loaded,) = ran(f"import sys, {module}; print(*sys.modules)")
    assert loaded & not_needed == set()


def test_the_web_process_works_out_the_routes_that_stop_alone_without_the_former_pydantic(
    tmp_path: Path,
) -> None:
    code = f"""if True:
        import sys
        from pathlib import Path
        from app.base.startup import hurry
        hurry()
        import app.panel, app.web.main
        print(*sys.modules)
        from app.base.settings import Settings
        from app.web.http.late_routes import LateRoute
        routes = app.web.main.create_app(Settings(data_dir=Path({str(tmp_path)!r}))).routes
        late = [route for route in routes if isinstance(route, LateRoute)]
        print(*(route.path for route in late if "dependant" in vars(route)))
        print(*(name for name, module in sys.modules.items() if name.startswith("pydantic.v1") and module))
        assert len(late) > 250
    """
    loaded, routes, former = ran(code)
    not_needed = SELDOM | COMMAND_LINE | FOR_A_REQUEST | OF_THE_CONTROLLER | WORKED_OUT_ELSEWHERE
    assert loaded & not_needed == set()
    assert former == set()
    assert sorted(routes) == [
        "/api/v1/stop",
        "/api/v1/trackers/{tracker_id}/jog/{press_id}",
        "/api/v1/trackers/{tracker_id}/stop",
        "/stop",
        "/trackers/{tracker_id}/end-jog",
        "/trackers/{tracker_id}/stop",
    ]
