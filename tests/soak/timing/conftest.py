"""The product and a simulated drive as the gate's own tests of the whole product have them."""

from tests.e2e.conftest import drive, eyes, integrator, product

__all__ = ["drive", "eyes", "integrator", "product"]
