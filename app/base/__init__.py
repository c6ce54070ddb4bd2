"""What every room stands on: clock, angles, errors, messages, settings of the environment."""
