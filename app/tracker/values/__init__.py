"""The small values that all parts of a tracker speak in: mode, motion, reasons."""
