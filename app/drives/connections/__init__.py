"""From a tracker's settings to the drive on its bus; searches and probes of a bus."""
