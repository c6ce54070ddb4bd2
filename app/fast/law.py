from math import cos, sin, radians
from app.tracker.config import NightBehaviour
from app.tracker.mount import mode_direction

TWILIGHT_DEG = -1.0


def night_direction(config, mode, held, dawn):
    if config.night is NightBehaviour.HOLD:
        return None
    if config.night is NightBehaviour.PARK:
        return config.park
    return None if dawn is None else mode_direction(mode, held, dawn, refraction=config.refraction)


def night_near_deg(config, location, dawn):
    if dawn is None or location is None:
        return config.azimuth.minimum_deg
    lat = radians(location.latitude_deg)
    return (
        config.azimuth.minimum_deg
        if sin(lat) > cos(lat) * cos(radians(dawn.azimuth_deg))
        else config.azimuth.maximum_deg
    )
