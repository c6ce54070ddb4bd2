"""The wire of a Modbus TCP bus: pymodbus frames, we check every byte that comes back."""

import asyncio
import logging
import socket
from collections.abc import Awaitable

from pymodbus.client import AsyncModbusTcpClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU

from app.base.message import N_, NOTHING, Message, join, say, told_by
from app.modbus.reply import BadReply, Wanted, is_complete
from app.modbus.wire import Ask, Broken, GivenUp, Refused, Timing, Unanswered

STOP_PATIENCE_S = 0.03
CONNECT_WITHIN_S = 0.3
WHY_WITHIN_S = 0.3
CHECK = N_("Check its power, cable, and address, and that its port uses Modbus TCP only.")


class TcpWire:
    """A connection to a device or a gateway; one that brought a bad or no reply is closed.

    Transaction numbers go on across connections, so that a gateway's late reply never fits a new request.
    """

    def __init__(self, host: str, port: int, connect_within_s: float = CONNECT_WITHIN_S) -> None:
        logging.getLogger("pymodbus").setLevel(logging.CRITICAL + 1)
        self._host = host
        self._port = port
        self._connect_within_s = connect_within_s
        self._client: AsyncModbusTcpClient | None = None
        self._wanted: Wanted | None = None
        self._hurrying: asyncio.TimerHandle | None = None
        self._transaction = 0
        self._connections = 0
        self._why = ""

    @property
    def connected(self) -> bool:
        """Return whether there is a live connection."""
        return self._client is not None and self._client.connected

    @property
    def advice(self) -> str:
        """Return what to check when there is no connection."""
        return join(" ", (self._why, CHECK)) if self._why else CHECK

    def epoch(self, unit: int) -> int:
        """Return a number that grows with every new and every lost connection."""
        return self._connections

    async def connect(self) -> bool:
        """Connect, and return whether that worked."""
        self.close()
        client = AsyncModbusTcpClient(
            self._host,
            port=self._port,
            timeout=self._connect_within_s,
            retries=0,
            reconnect_delay=0,
            trace_packet=self._inspect,
            trace_connect=self._notice,
        )
        self._client = client
        if not await client.connect():
            self.close()
            self._why = await _why_not(self._host, self._port)
            return False
        self._why = ""
        client.ctx.next_tid = self._transaction
        self._connections += 1
        return True

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        """Return the registers of the reply; raise `Broken`, `Unanswered` or `Refused`."""
        client = self._client
        if client is None:
            raise Broken(N_("the connection was lost"))
        client.ctx.comm_params.timeout_connect = timing.timeout_s
        self._wanted = ask.wanted
        try:
            reply = await _asked(client, ask)
        except BadReply as bad:
            self.close()
            raise Broken(told_by(bad)) from bad
        except ModbusException as error:
            self.close()
            raise Unanswered from error
        except GivenUp:
            self.close()
            raise
        finally:
            self._wanted = None
            self._calm()
        if reply.isError():
            raise Refused(reply.exception_code)
        return list(reply.registers)

    def hurry(self) -> None:
        """Wait only a moment longer for the reply: the connection is given up then, and a stop goes."""
        if self._wanted is not None and self._hurrying is None:
            loop = asyncio.get_running_loop()
            self._hurrying = loop.call_later(STOP_PATIENCE_S, self._end_wait, GivenUp())

    def close(self) -> None:
        """Let go of the connection."""
        client, self._client = self._client, None
        if client is not None:
            self._connections += 1
            self._transaction = client.ctx.next_tid
            client.close()

    def _calm(self) -> None:
        if self._hurrying is not None:
            self._hurrying.cancel()
            self._hurrying = None

    def _inspect(self, sending: bool, data: bytes) -> bytes:
        """Let only the complete, right reply through to the decoder; end the wait at the first wrong byte."""
        if sending or self._client is None:
            return data
        try:
            if self._wanted is None:
                raise BadReply(N_("unrequested data arrived"))
            complete = is_complete(data, self._wanted, self._client.ctx.request_transaction_id)
        except BadReply as bad:
            self._end_wait(bad)
            return b""
        return data if complete else b""

    def _notice(self, connected: bool) -> None:
        """End the wait for a reply as soon as the connection is lost."""
        if not connected:
            self._end_wait(BadReply(N_("the connection was lost")))

    def _end_wait(self, why: Exception) -> None:
        if self._client is None:
            return
        future = self._client.ctx.response_future
        if self._wanted is not None and not future.done():
            future.set_exception(why)
        else:
            self.close()


def _asked(client: AsyncModbusTcpClient, ask: Ask) -> Awaitable[ModbusPDU]:
    """Return the reply to come, of which `_inspect` has checked every byte before pymodbus decodes it."""
    if not ask.words:
        return client.read_holding_registers(ask.address, count=ask.count, device_id=ask.unit)
    if ask.count == 1:
        return client.write_register(ask.address, ask.words[0], device_id=ask.unit)
    return client.write_registers(ask.address, list(ask.words), device_id=ask.unit)


async def _why_not(host: str, port: int) -> Message:
    """Return a sentence that says how a connection fails, as pymodbus does not tell."""
    try:
        async with asyncio.timeout(WHY_WITHIN_S):
            _, writer = await asyncio.open_connection(host, port)
    except ConnectionRefusedError:
        return say("The device at {host} answers, but nothing listens on port {port}.", host=host, port=port)
    except socket.gaierror:
        return say("The host name {host} is not known.", host=host)
    except (OSError, TimeoutError):
        return say("No device answers at {host}.", host=host)
    writer.transport.abort()
    return NOTHING
