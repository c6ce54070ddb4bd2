"""The core: what one tracker knows, wants and does. Pure: time and measurements come in as arguments."""
