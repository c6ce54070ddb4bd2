"""One folder a feature: its pages, contexts and API. A feature imports no other."""
