"""The machine's other doors: SunSpec over Modbus, MQTT."""
