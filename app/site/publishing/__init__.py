"""What the site tells: pictures, deltas, alarms, its health."""
