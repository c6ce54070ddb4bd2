"""Energy studies of a site, worked out in a process of their own."""
