"""The weather as a tracker takes it: measured, simulated, and played; and how long a report counts."""
