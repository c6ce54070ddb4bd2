"""A Modbus server made with modbus_tk, for our master to ask: `tcp PORT` or `rtu PATH`.

Unit 17, 200 holding registers of which number n holds 3 n + 1 until it is written.
"""

import socket
import sys
import threading
import time

import serial
from modbus_tk import defines, modbus_rtu, modbus_tcp

UNIT, REGISTERS = 17, 200


def main() -> None:
    kind, where = sys.argv[1:3]
    if kind == "tcp":
        server = modbus_tcp.TcpServer(port=int(where), address="127.0.0.1")
    else:
        server = modbus_rtu.RtuServer(serial.Serial(where, 19200, parity="N"))
    block = server.add_slave(UNIT)
    block.add_block("holding", defines.HOLDING_REGISTERS, 0, REGISTERS)
    block.set_values("holding", 0, [3 * number + 1 for number in range(REGISTERS)])
    server.start()
    while kind == "tcp" and not _listening(int(where)):
        time.sleep(0.01)
    print("ready", flush=True)
    threading.Event().wait()


def _listening(port: int) -> bool:
    """Return whether the server's own thread has come so far."""
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


if __name__ == "__main__":
    main()
