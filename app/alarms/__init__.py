"""Alarms after ANSI/ISA-18.2: which there are, when they are active, and what became of each."""
