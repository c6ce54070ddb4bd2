"""What is asked before a location is saved that is likely to be mistaken, and what its answers mean."""

from collections.abc import Callable, Sequence

from app.base.message import N_, NOTHING, Message
from app.sun.position import Location
from app.web.features.site.location_contexts import PlaceQuestion
from app.web.features.site.place import Doubt, Mistake, mended
from app.web.shell import coordinates

SWAP = "swapped"
DOUBTED = {
    Mistake.EAST_WEST: "longitude",
    Mistake.NORTH_SOUTH: "latitude",
    Mistake.SWAPPED: "latitude longitude",
}
USE = {
    "N": N_("Use north"),
    "S": N_("Use south"),
    "E": N_("Use east"),
    "W": N_("Use west"),
    SWAP: N_("Swap coordinates"),
}
KEEP = {"N": N_("Keep north"), "S": N_("Keep south"), "E": N_("Keep east"), "W": N_("Keep west")}
KEEP_THIS = N_("Keep this location")
MISTAKES = {
    "N": Mistake.NORTH_SOUTH,
    "S": Mistake.NORTH_SOUTH,
    "E": Mistake.EAST_WEST,
    "W": Mistake.EAST_WEST,
    SWAP: Mistake.SWAPPED,
}


def text_of(place: Location, time_zone: str) -> str:
    """Return what stands for a location that was asked about: an answer counts for no other."""
    return f"{place.latitude_deg:.7f} {place.longitude_deg:.7f} {time_zone}"


def likeliest(doubts: Sequence[Doubt]) -> Doubt | None:
    """Return the first doubt that knows what was meant, None if none does."""
    return next((doubt for doubt in doubts if doubt.other is not None), None)


def question(
    place: Location,
    time_zone: str,
    doubts: Sequence[Doubt],
    doubts_of: Callable[[Location], Sequence[Doubt]],
    *,
    is_compared: bool,
) -> PlaceQuestion:
    """Return what is asked about a location; what the likelier location would mend is not told besides."""
    asked_for = text_of(place, time_zone)
    likely = likeliest(doubts)
    if likely is None or likely.mistake is None or likely.other is None:
        told = tuple(doubt.sentence for doubt in doubts)
        return PlaceQuestion(told, "", NOTHING, KEEP_THIS, asked_for, "latitude longitude", is_compared)
    left = {doubt.sentence.template for doubt in doubts_of(likely.other)}
    rest = [doubt.sentence for doubt in doubts if doubt is not likely and doubt.sentence.template in left]
    instead = _answer(likely.other, likely.mistake)
    return PlaceQuestion(
        (likely.sentence, *rest),
        instead,
        USE[instead],
        _keep(place, likely.mistake),
        asked_for,
        DOUBTED[likely.mistake],
        is_compared,
    )


def _answer(place: Location, mistake: Mistake) -> str:
    match mistake:
        case Mistake.EAST_WEST:
            return "W" if place.longitude_deg < 0 else "E"
        case Mistake.NORTH_SOUTH:
            return "S" if place.latitude_deg < 0 else "N"
        case Mistake.SWAPPED:
            return SWAP


def _keep(place: Location, mistake: Mistake) -> Message:
    return KEEP.get(_answer(place, mistake), KEEP_THIS)


def instead_of(place: Location, answer: str) -> dict[str, str]:
    """Return the texts of the form with the location that an answer names, none for an unknown answer."""
    mistake = MISTAKES.get(answer)
    other = mended(place, mistake) if mistake else None
    if mistake is None or other is None:
        return {}
    if mistake is not Mistake.SWAPPED and _answer(other, mistake) != answer:
        other = place
    return {
        "latitude": coordinates.degrees_text(abs(other.latitude_deg)),
        "longitude": coordinates.degrees_text(abs(other.longitude_deg)),
        "latitude_side": "S" if other.latitude_deg < 0 else "N",
        "longitude_side": "W" if other.longitude_deg < 0 else "E",
    }
