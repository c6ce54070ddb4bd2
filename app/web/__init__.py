"""The panel process: pages for people, REST for integrators, one machine behind both."""
