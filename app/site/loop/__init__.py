"""The turns of all trackers on one clock: scheduled, spread, and lighter under load."""
