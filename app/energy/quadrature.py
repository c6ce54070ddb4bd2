"""Integrals over parts of a day, by Gauss and Legendre's rule on short panels."""

from collections.abc import Callable
from functools import cache

import numpy as np

from app.sun.trigonometry import Array

LONGEST_PANEL_H = 0.25


@cache
def _rule() -> tuple[Array, Array]:
    """Return nodes and weights from -1 to 1; worked out when first wanted, as NumPy loads much for it."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    return nodes, weights


def nodes_between(begin_h: float, end_h: float) -> tuple[Array, Array]:
    """Return the instants and weights, hours, of a rule whose weighted sum is the integral over the span.

    Both are one-dimensional and equally long; empty where the span is.
    """
    if end_h <= begin_h:
        return np.empty(0), np.empty(0)
    nodes, weights = _rule()
    count = int(np.ceil((end_h - begin_h) / LONGEST_PANEL_H))
    edges = np.linspace(begin_h, end_h, count + 1)
    half_h = (end_h - begin_h) / (2 * count)
    at_h = (edges[:-1, None] + half_h * (1.0 + nodes)).ravel()
    return at_h, np.tile(half_h * weights, count)


def integral(of: Callable[[Array], Array], begin_h: float, end_h: float) -> float:
    """Return the integral of a function of hours over a span: of watts, watt hours."""
    at_h, weight_h = nodes_between(begin_h, end_h)
    return float(of(at_h) @ weight_h)
