"""What an engineer sets of a tracker: machine, mount, protections, limits."""
