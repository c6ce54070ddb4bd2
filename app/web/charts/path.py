"""Lines of a drawing as SVG path data."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray


def line(x: NDArray[np.float64], y: NDArray[np.float64], shown: NDArray[np.bool_] | None = None) -> str:
    """Return a line through some points, broken where they are not shown."""
    drawn, pen_down = [], False
    seen = [True] * len(x) if shown is None else shown.tolist()
    for at_x, at_y, here in zip(x.tolist(), y.tolist(), seen, strict=True):
        if here:
            drawn.append(f"{'L' if pen_down else 'M'}{at_x:.1f} {at_y:.1f}")
        pen_down = here
    return "".join(drawn)


def closed(corners: Iterable[tuple[float, float]]) -> str:
    """Return the outline of a shape."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in corners) + "Z"
