"""The tracker under somebody's hands: overview, modes, orders, live values."""
