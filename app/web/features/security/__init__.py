"""Audit, certificate and network."""
