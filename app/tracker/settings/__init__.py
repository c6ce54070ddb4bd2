"""What an engineer sets for a tracker, each field declared once with its bounds, label, unit, and help."""
