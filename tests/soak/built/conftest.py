"""The product and a simulated drive as the timing tests have them."""

from tests.soak.timing.conftest import drive, integrator, product

__all__ = ["drive", "integrator", "product"]
