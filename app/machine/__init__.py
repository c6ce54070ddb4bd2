"""The controller service: the process that owns the drives."""
