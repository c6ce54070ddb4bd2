"""The orders as data, and who may give them."""
