"""Turns Natural Earth's coastline (TopoJSON of world-atlas) into one SVG path in `static/img/world.svg`.

The picture is 3600 x 1800 units, ten a degree: x = 10 (longitude + 180), y = 10 (90 - latitude).
"""

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
SOURCE = HERE / "world" / "2.0.2" / "land-110m.json"
TARGET = HERE.parent / "img" / "world.svg"
SMALLEST_SPAN_DEG = 1.2
POLAR_CAP_DEG = -84.0
Point = tuple[float, float]


def arcs(topology: dict[str, Any]) -> list[list[Point]]:
    """Return every arc as longitudes and latitudes, its delta coding undone."""
    (scale_x, scale_y), (move_x, move_y) = topology["transform"]["scale"], topology["transform"]["translate"]
    decoded = []
    for arc in topology["arcs"]:
        x = y = 0
        points = []
        for step_x, step_y in arc:
            x, y = x + step_x, y + step_y
            points.append((x * scale_x + move_x, y * scale_y + move_y))
        decoded.append(points)
    return decoded


def ring(indices: list[int], known: list[list[Point]]) -> list[Point]:
    """Return one closed ring; a negative index runs its arc backwards."""
    points: list[Point] = []
    for index in indices:
        arc = known[index] if index >= 0 else known[~index][::-1]
        points += arc[1:] if points else arc
    return unwrapped(points)


def unwrapped(points: list[Point]) -> list[Point]:
    """Return the ring without its jumps across the antimeridian; it may then reach beyond 180 degrees."""
    shift, joined = 0.0, points[:1]
    for before, after in pairwise(points):
        step = after[0] - before[0]
        if abs(step) > 180.0 and after[1] > POLAR_CAP_DEG:
            shift += -360.0 if step > 0 else 360.0
        joined.append((after[0] + shift, after[1]))
    return joined


def copies(points: list[Point]) -> list[list[Point]]:
    """Return the ring, and where it reaches beyond the map its copy on the other side."""
    longitudes = [longitude for longitude, _ in points]
    shifts = [0.0]
    if max(longitudes) > 180.0:
        shifts.append(-360.0)
    if min(longitudes) < -180.0:
        shifts.append(360.0)
    return [[(longitude + shift, latitude) for longitude, latitude in points] for shift in shifts]


def path(points: list[Point]) -> str:
    """Return the ring as relative SVG steps in tenths of a degree, or nothing if it is too small to see."""
    longitudes, latitudes = zip(*points, strict=True)
    if max(max(longitudes) - min(longitudes), max(latitudes) - min(latitudes)) < SMALLEST_SPAN_DEG:
        return ""
    tenths = [(round((lon + 180) * 10), round((90 - lat) * 10)) for lon, lat in points]
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(tenths) if a != b]
    drawn = "".join(f"{x}{y:+d}" if i == 0 or x < 0 else f" {x}{y:+d}" for i, (x, y) in enumerate(steps))
    return f"M{tenths[0][0]} {tenths[0][1]}l{drawn}z"


def main() -> None:
    """Write the picture."""
    topology = json.loads(SOURCE.read_text())
    known = arcs(topology)
    polygons = topology["objects"]["land"]["geometries"][0]["arcs"]
    rings = [ring(indices, known) for polygon in polygons for indices in polygon]
    drawn = "".join(path(copy) for points in rings for copy in copies(points))
    TARGET.parent.mkdir(exist_ok=True)
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 3600 1800">'
    TARGET.write_text(f'{head}<path id="land" d="{drawn}"/></svg>\n')


if __name__ == "__main__":
    main()
