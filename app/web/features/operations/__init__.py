"""Backups, diagnostics, metrics and what is installed."""
