"""Simulated devices, register by register as their makers describe them; nothing here knows the adapters."""
