"""A Modbus server made with modbus_tk, for our master to ask: `tcp PORT` or `rtu PATH`.

Unit 17, 200 holding registers of which number n holds 3 n + 1 until it is written.
"""

import sys
import threading

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
    print("ready", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    main()
