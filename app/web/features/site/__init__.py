"""The site: place, clock, horizon, weather."""
