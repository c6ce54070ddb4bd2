"""Drives behind one small protocol: profiles, scaling, dialects and connections."""
