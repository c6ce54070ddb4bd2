"""Keeps the tests and all they start on this computer: nobody but loopback and Unix sockets is called.

The interpreter itself asks before each call (`sys.addaudithook`), so what is refused never reaches Linux and
nothing can take the guard off again. The folder stands in PYTHONPATH: Python imports a module of this name in
every process that a test starts. Two modules are wrapped once they are imported: sockets, which look a name
up before the interpreter asks, and uvloop, which asks nobody.
"""

import os
import sys
from collections.abc import Callable
from functools import wraps
from typing import Any

LOCAL_NAMES = {"localhost", "ip6-localhost", "heliopanel.localhost"}
CHROMIUM_FLAGS = ["--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1 , EXCLUDE localhost"]
"""What keeps Chromium, which is no Python, on this computer."""


class CalledElsewhere(PermissionError):
    """A test called another computer; the product takes it for a network that is down."""

    def __init__(self, where: object) -> None:
        super().__init__(1, f"Tests stay on this computer; refused to call {where!r}")


def packed(host: str) -> bytes | None:
    """Return the bytes of an address, None for a name."""
    import _socket  # noqa: PLC0415 - a process without sockets does not need it

    for family in (_socket.AF_INET, _socket.AF_INET6):
        try:
            return _socket.inet_pton(family, host.partition("%")[0])
        except (OSError, ValueError):
            continue
    return None


def is_here(host: object) -> bool:
    """Return whether this names this computer's loopback without asking anybody."""
    name = host.decode("ascii", "replace") if isinstance(host, bytes | bytearray) else host
    if not isinstance(name, str):
        return False
    address = packed(name)
    if address is None:
        return name.lower() in LOCAL_NAMES
    mapped = address[12:] if address[:12] == b"\0" * 10 + b"\xff\xff" else address
    return mapped[0] == 127 if len(mapped) == 4 else mapped == b"\0" * 15 + b"\1"


def _multicast_on_loopback(sock: Any, host: object) -> bool:
    """Return whether this socket says to a group what it says on the loopback interface alone."""
    import _socket  # noqa: PLC0415 - as above

    address = packed(host) if isinstance(host, str) else None
    if address is None or len(address) != 4 or not 224 <= address[0] < 240:
        return False
    return bool(sock.getsockopt(_socket.IPPROTO_IP, _socket.IP_MULTICAST_IF, 4)[0] == 127)


def _calls(sock: Any, address: Any) -> None:
    import _socket  # noqa: PLC0415 - as above

    if sock.family in (_socket.AF_UNIX, getattr(_socket, "AF_NETLINK", None)) or address is None:
        return
    host = address[0] if isinstance(address, tuple) and address else address
    if sock.family not in (_socket.AF_INET, _socket.AF_INET6) or not (
        is_here(host) or _multicast_on_loopback(sock, host)
    ):
        raise CalledElsewhere(address)


def _asks(host: object, *_: object) -> None:
    """Refuse to look up a name; an address needs nobody to be asked."""
    import _socket  # noqa: PLC0415 - as above

    name = host.decode("ascii", "replace") if isinstance(host, bytes | bytearray) else host
    if name and not is_here(name) and packed(str(name)) is None:
        raise _socket.gaierror(
            _socket.EAI_NONAME, f"Tests stay on this computer; refused to look up {name!r}"
        )


def _asks_back(address: Any, *_: object) -> None:
    if not is_here(address[0] if isinstance(address, tuple) else address):
        raise CalledElsewhere(address)


GUARDED: dict[str, Callable[..., None]] = {
    "socket.connect": _calls,
    "socket.sendto": _calls,
    "socket.sendmsg": _calls,
    "socket.getaddrinfo": _asks,
    "socket.gethostbyname": _asks,
    "socket.gethostbyaddr": _asks_back,
    "socket.getnameinfo": _asks_back,
}


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if event in GUARDED:
        GUARDED[event](*arguments)


def _wrap_sockets(module: Any) -> None:
    """Have the name in an address refused before it is looked up."""
    for method in ("bind", "connect", "connect_ex", "sendto"):
        setattr(module.socket, method, _asking(getattr(module.socket, method)))


def _asking(method: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(method)
    def asked(self: Any, *arguments: Any) -> Any:
        if arguments and isinstance(arguments[-1], tuple) and isinstance(arguments[-1][0], str):
            _asks(arguments[-1][0])
        return method(self, *arguments)

    return asked


def _wrap_uvloop(module: Any) -> None:
    """Have uvloop's own calls refused, too; its datagrams all of them."""
    connect, look_up = module.Loop.create_connection, module.Loop.getaddrinfo

    async def create_connection(self: Any, factory: Any, host: Any = None, *rest: Any, **more: Any) -> Any:
        if host is not None and not is_here(host):
            raise CalledElsewhere(host)
        return await connect(self, factory, host, *rest, **more)

    async def create_datagram_endpoint(self: Any, *_: Any, **more: Any) -> Any:
        raise CalledElsewhere("somebody by uvloop's datagrams")

    async def getaddrinfo(self: Any, host: Any, *rest: Any, **more: Any) -> Any:
        _asks(host)
        return await look_up(self, host, *rest, **more)

    module.Loop.create_connection = create_connection
    module.Loop.create_datagram_endpoint = create_datagram_endpoint
    module.Loop.getaddrinfo = getaddrinfo


WRAPPED: dict[str, Callable[[Any], None]] = {"socket": _wrap_sockets, "uvloop": _wrap_uvloop}


class _WhenImported:
    """Wraps a module once it is imported: uvloop weighs too much to be imported everywhere."""

    def __init__(self, name: str) -> None:
        self._name = name

    def find_spec(self, name: str, path: object = None, target: object = None) -> Any:
        if name != self._name:
            return None
        sys.meta_path.remove(self)  # type: ignore[arg-type]
        from importlib.util import find_spec  # noqa: PLC0415 - as above

        spec = find_spec(name)
        if spec is not None and spec.loader is not None:
            load = spec.loader.exec_module

            def exec_module(module: Any) -> None:
                load(module)
                WRAPPED[name](module)

            spec.loader.exec_module = exec_module  # type: ignore[method-assign]
        return spec


def stay_here() -> None:
    """Guard this process, once, and every Python that it starts."""
    if getattr(sys, "stays_here", False):
        return
    sys.stays_here = True  # type: ignore[attr-defined]
    folder = os.path.dirname(os.path.abspath(__file__))
    before = os.environ.get("PYTHONPATH", "")
    if folder not in before.split(os.pathsep):
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (folder, before)))
    sys.addaudithook(_audit)
    for name, wrap in WRAPPED.items():
        if name in sys.modules:
            wrap(sys.modules[name])
        else:
            sys.meta_path.insert(0, _WhenImported(name))  # type: ignore[arg-type]


stay_here()
