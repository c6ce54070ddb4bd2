"""The map of the location page: a part of the world around a place, day and night on it, and the sun."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from app.sun.position import Algorithm, InstantRefused, Location
from app.sun.terminator import subsolar_point, terminator_deg
from app.web.features.site.location_contexts import MapMark, SiteMap
from app.web.features.site.place import Mistake
from app.web.languages import pgettext
from app.web.shell.formats import decimals

PER_DEG = 10.0
"""Units of the world's path to a degree."""
WORLD_WIDTH, WORLD_HEIGHT = 360.0 * PER_DEG, 180.0 * PER_DEG
RATIO = 304.0 / 400.0
CROP_DEG, LARGER_DEG = 200.0, 60.0
"""How many degrees of longitude the map, and the larger one, shows around a place."""
ROOM = 1.4
"""How much wider than the distance of two places a map is that has both."""
STEP_DEG = 3
EDGE_DEG = 9
"""So far the map goes on beyond the date line and the poles: a mark there is seen whole."""
EDGE = PER_DEG * EDGE_DEG
LABEL_PERCENT = 13.0
"""How far from the edge of the map the middle of a label is at the least."""
LABELS_APART = (24.0, 14.0)
"""Across and down: labels of marks that are nearer do not both stand above them."""
TOP_PERCENT = 13.0


@dataclass(frozen=True, slots=True)
class Crop:
    """The part of the world's path that a map shows."""

    x: float
    y: float
    width: float

    @property
    def height(self) -> float:
        """Return its height, by the ratio of every map."""
        return self.width * RATIO

    @property
    def view_box(self) -> str:
        """Return it as SVG has it."""
        return f"{self.x:.1f} {self.y:.1f} {self.width:.1f} {self.height:.1f}"

    def percent(self, place: Location) -> tuple[float, float]:
        """Return where a place is, in percent of the width and the height."""
        x, y = on_path(place)
        return round((x - self.x) / self.width * 100.0, 2), round((y - self.y) / self.height * 100.0, 2)


def on_path(place: Location) -> tuple[float, float]:
    """Return where a place is on the world's path."""
    return PER_DEG * (place.longitude_deg + 180.0), PER_DEG * (90.0 - place.latitude_deg)


def crop_around(places: Sequence[Location], width_deg: float) -> Crop:
    """Return a part of the map with all of these places, the whole world for none.

    It ends at the date line and the poles: a place near them is not in the middle.
    """
    if not places:
        return _centered(WORLD_WIDTH / 2, WORLD_HEIGHT / 2, WORLD_WIDTH)
    across, down = zip(*map(on_path, places), strict=True)
    wide = max(across) - min(across)
    high = max(down) - min(down)
    width = min(WORLD_WIDTH + 2 * EDGE, max(PER_DEG * width_deg, ROOM * wide, ROOM * high / RATIO))
    return _centered((max(across) + min(across)) / 2, (max(down) + min(down)) / 2, width)


def _centered(x: float, y: float, width: float) -> Crop:
    height = width * RATIO
    left = min(max(x - width / 2, -EDGE), WORLD_WIDTH + EDGE - width)
    if height > WORLD_HEIGHT + 2 * EDGE:
        return Crop(left, (WORLD_HEIGHT - height) / 2, width)
    return Crop(left, min(max(y - height / 2, -EDGE), WORLD_HEIGHT + EDGE - height), width)


def night_path(subsolar: Location) -> str:
    """Return the half of the Earth where it is night as path data; it goes on above and below the poles."""
    longitudes = range(-180 - EDGE_DEG, 181 + EDGE_DEG, STEP_DEG)
    line = ((PER_DEG * (deg + 180.0), PER_DEG * (90.0 - terminator_deg(subsolar, deg))) for deg in longitudes)
    dark = WORLD_HEIGHT * 2 if subsolar.latitude_deg >= 0 else -WORLD_HEIGHT
    edge = "L".join(f"{x:.0f} {y:.0f}" for x, y in line)
    return f"M{edge}L{WORLD_WIDTH + EDGE:.0f} {dark:.0f}L{-EDGE:.0f} {dark:.0f}Z"


def site_map(
    algorithm: Algorithm,
    now: datetime,
    places: Sequence[Location],
    mistake: Mistake | None = None,
    *,
    is_asked: bool = False,
    width_deg: float = CROP_DEG,
) -> SiteMap:
    """Return the map around the entered place and, while it is asked about, the one that may be meant."""
    crop = crop_around(places, width_deg)
    marks = _marks(crop, places, mistake, is_asked=is_asked)
    try:
        subsolar = subsolar_point(algorithm, now)
    except InstantRefused:
        return SiteMap(crop.view_box, "", marks, None)
    sun = MapMark("sun", *crop.percent(subsolar))
    return SiteMap(crop.view_box, night_path(subsolar), marks, sun)


def _marks(
    crop: Crop, places: Sequence[Location], mistake: Mistake | None, *, is_asked: bool
) -> tuple[MapMark, ...]:
    spots = [crop.percent(place) for place in places]
    kinds = ("doubted", "other") if is_asked else ("place",)
    below = [y < TOP_PERCENT for _, y in spots]
    if len(spots) == 2 and all(
        abs(one - other) < least for one, other, least in zip(*spots, LABELS_APART, strict=True)
    ):
        is_first_higher = spots[0][1] <= spots[1][1]
        below = [not is_first_higher, is_first_higher]
    return tuple(
        MapMark(kind, x, y, label_of(place, mistake), min(max(x, LABEL_PERCENT), 100 - LABEL_PERCENT), low)
        for kind, place, (x, y), low in zip(kinds, places, spots, below, strict=False)
    )


def label_of(place: Location, mistake: Mistake | None = None) -> str:
    """Return the coordinate by which a place differs from the one it is mistaken for, such as `32.48° W`."""
    if mistake in (Mistake.NORTH_SOUTH, Mistake.SWAPPED):
        return f"{decimals(abs(place.latitude_deg), 2)}° {side_of(place, mistake)}"
    return f"{decimals(abs(place.longitude_deg), 2)}° {side_of(place, Mistake.EAST_WEST)}"


def side_of(place: Location, mistake: Mistake) -> str:
    """Return the letter of the side by which a place differs, in the language of the page."""
    if mistake is Mistake.EAST_WEST:
        letter = "W" if place.longitude_deg < 0 else "E"
    else:
        letter = "S" if place.latitude_deg < 0 else "N"
    return pgettext("compass", letter)
