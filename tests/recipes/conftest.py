"""The recipes are followed where releases are built: each copies the program and runs it once or more."""

from tests.soak import SOAK

collect_ignore_glob = [] if SOAK else ["test_recipe_*.py"]
