"""Heliopanel commissions a solar tracker in the browser and keeps it on the sun."""
