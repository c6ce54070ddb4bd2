"""The site's weather: stations and their series, what survives a restart, the sky."""
