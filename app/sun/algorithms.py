"""The published sun position algorithms by name: what each is, where it is from, how far off it is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from app.base.message import N_, Message, say, with_format
from app.sun import alexandru, cooper, fast, koblick, psa, psa_plus, spa, spencer_lamm
from app.sun.trigonometry import ARRAY, SCALAR, Array, Trigonometry

One = Callable[[float, float, float], tuple[float, float]]
Many = Callable[[Array, float, float], tuple[Array, Array]]


class Algorithm(StrEnum):
    """A published sun position algorithm."""

    PSA = "psa"
    PSA_PLUS = "psa-plus"
    KOBLICK = "koblick"
    KOBLICK_PARALLAX = "koblick-parallax"
    SPENCER_LAMM = "spencer-lamm"
    SPENCER_LAMM_PHASE = "spencer-lamm-phase"
    COOPER = "cooper"
    COOPER_EOT = "cooper-eot"
    ALEXANDRU = "alexandru"
    SPA = "spa"


@dataclass(frozen=True, slots=True)
class Published:
    """An algorithm: its title, its source, its separation from NREL SPA, and its functions.

    `max_deg` and `rms_deg` are the greatest and the root mean square separation with the sun up, 2000 to
    2049, latitude -65 to 65, without refraction; for SPA itself, its stated uncertainty. `one` takes an
    instant, `many` an array of them: seconds since 1970 UT, latitude north, longitude east, degrees; both
    return azimuth clockwise from north, not wrapped, and true elevation, degrees.
    """

    title: str
    source: str
    doi: str
    max_deg: float
    rms_deg: float
    one: One
    many: Many

    @property
    def expected(self) -> Message:
        """Return the title with the error to expect beside it."""
        return say(
            "{title}, error up to {max_deg}°", title=self.title, max_deg=with_format(self.max_deg, "g")
        )


def _one(position: Callable[[float, float, float, Trigonometry[float]], tuple[float, float]]) -> One:
    return lambda unix_s, latitude_deg, longitude_deg: position(unix_s, latitude_deg, longitude_deg, SCALAR)


def _many(position: Callable[[Array, float, float, Trigonometry[Array]], tuple[Array, Array]]) -> Many:
    return lambda unix_s, latitude_deg, longitude_deg: position(unix_s, latitude_deg, longitude_deg, ARRAY)


_COOPER = N_("Cooper, Solar Energy 12 (1969) 333-346, as in Nalini and Hemavathi (2023)")
_COOPER_DOI = "10.1016/0038-092X(69)90047-4"
_LAMM = N_("Spencer, Search 2 (1971) 172, and Lamm, Solar Energy 26 (1981) 465, as in Xia et al. (2015)")
_LAMM_DOI = "10.1016/0038-092X(81)90229-2"
_KOBLICK = N_("Koblick, MATLAB Central 23051 (2008), as in Gezegin and Dirik (2022)")

PUBLISHED: Final[Mapping[Algorithm, Published]] = MappingProxyType(
    {
        Algorithm.PSA: Published(
            N_("PSA (2001)"),
            N_("Blanco-Muriel et al., Solar Energy 70 (2001) 431-441"),
            "10.1016/S0038-092X(00)00156-0",
            0.0099,
            0.0033,
            fast.psa,
            _many(psa.position),
        ),
        Algorithm.PSA_PLUS: Published(
            N_("PSA+ (2020)"),
            N_("Blanco, Milidonis and Bonanos, Solar Energy 212 (2020) 339-341"),
            "10.1016/j.solener.2020.10.084",
            0.0085,
            0.0029,
            fast.psa_plus,
            _many(psa_plus.position),
        ),
        Algorithm.KOBLICK: Published(
            N_("Koblick"), _KOBLICK, "", 0.0124, 0.0044, fast.koblick, _many(koblick.position)
        ),
        Algorithm.KOBLICK_PARALLAX: Published(
            N_("Koblick with parallax"),
            _KOBLICK,
            "",
            0.0100,
            0.0040,
            _one(koblick.position_with_parallax),
            _many(koblick.position_with_parallax),
        ),
        Algorithm.SPENCER_LAMM: Published(
            N_("Spencer and Lamm"),
            _LAMM,
            _LAMM_DOI,
            0.89,
            0.30,
            _one(spencer_lamm.position),
            _many(spencer_lamm.position),
        ),
        Algorithm.SPENCER_LAMM_PHASE: Published(
            N_("Spencer and Lamm, phase fixed"),
            _LAMM,
            _LAMM_DOI,
            0.12,
            0.044,
            _one(spencer_lamm.position_phase),
            _many(spencer_lamm.position_phase),
        ),
        Algorithm.COOPER: Published(
            N_("Cooper, as printed"),
            _COOPER,
            _COOPER_DOI,
            4.16,
            2.17,
            _one(cooper.position),
            _many(cooper.position),
        ),
        Algorithm.COOPER_EOT: Published(
            N_("Cooper with equation of time"),
            _COOPER,
            _COOPER_DOI,
            1.50,
            0.54,
            _one(cooper.position_with_equation_of_time),
            _many(cooper.position_with_equation_of_time),
        ),
        Algorithm.ALEXANDRU: Published(
            N_("Alexandru"),
            N_("Alexandru, Mathematics 12 (2024) 1034"),
            "10.3390/math12071034",
            1.87,
            0.64,
            _one(alexandru.position),
            _many(alexandru.position),
        ),
        Algorithm.SPA: Published(
            N_("NREL SPA"),
            N_("Reda and Andreas, Solar Energy 76 (2004) 577-589, by pvlib"),
            "10.1016/j.solener.2003.12.003",
            0.0003,
            0.0003,
            spa.position_of_one,
            spa.position,
        ),
    }
)
