"""The program's own Modbus: bus, lines, framing and servers; it knows no tracker."""
