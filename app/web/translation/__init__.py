"""What translators get: the texts of all sources, in catalogues. The running program imports none of it."""
