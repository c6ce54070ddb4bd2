"""The sun, a park and a year in compiled loops, where the optional extra `fast` (numba) is installed.

Everything here exists elsewhere in a form that needs no compiler; tests hold the two together.
"""
