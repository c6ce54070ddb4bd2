"""What judges time (timing), builds and installs the product (built), or takes hours (long)."""

from tests.amount import SOAK, amount

__all__ = ["SOAK", "amount"]
