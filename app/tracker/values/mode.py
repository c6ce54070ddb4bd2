"""What the operator selected, kept apart from what the machine is doing."""

from enum import StrEnum


class Mode(StrEnum):
    """The four modes of the operator panel's paper."""

    FIXED = "fixed"
    AZIMUTH = "azimuth"
    ELEVATION = "elevation"
    DUAL = "dual"
