"""Simulated devices as servers on a line, for `heliopanel drive-sim` and `fault-proxy`."""
