"""What the site is ordered to do: one handler for each order."""
