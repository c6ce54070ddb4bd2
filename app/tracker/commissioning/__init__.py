"""The five steps: what is done, the drive tests, the sun check, the mode."""
