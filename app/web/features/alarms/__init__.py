"""Alarms, journal and notifications."""
