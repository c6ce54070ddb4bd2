"""`heliopanel web`: the panel alone."""

from app.cli.options import Config, DataDir, Host, Port, settle
from app.panel import serve


def web(config: Config = None, data_dir: DataDir = None, host: Host = None, port: Port = None) -> None:
    """Run the panel alone, for a system service of its own."""
    serve(settle(config, data_dir, host, port))
