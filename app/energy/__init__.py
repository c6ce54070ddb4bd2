"""What tracking is worth: irradiance, energy, gain, and the best step program; pure NumPy."""
