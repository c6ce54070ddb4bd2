"""Weather files made here, in the forms in which they are downloaded: a plain sun over Samsun."""

from datetime import UTC, datetime, timedelta
from math import cos, pi, sin

HOURS = 8760
FIRST = datetime(2021, 1, 1, tzinfo=UTC)
LATITUDE, LONGITUDE, ALTITUDE = 41.28, 36.34, 4.0


def values(hour: int) -> tuple[int, int, int, float, float]:
    """Global, direct, diffuse, air and wind of an hour of local standard time: the sun culminates at 12.5."""
    day, of_day = divmod(hour, 24)
    season = cos(2 * pi * (day - 172) / 365)
    height = 0.55 + 0.3 * season
    up = max(0.0, sin(pi * (of_day + 0.5 - 6) / 13)) if 6 <= of_day < 19 else 0.0
    direct, diffuse = round(850 * up), round(110 * up)
    return round(direct * height * up) + diffuse, direct, diffuse, 14.0 + 9.0 * season, 2.5


def epw() -> bytes:
    head = [
        f"LOCATION,Samsun,-,TUR,made,170300,{LATITUDE},{LONGITUDE},2.0,{ALTITUDE}",
        "DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
        "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,made", "COMMENTS 2,made",
        "DATA PERIODS,1,1,Data,Sunday,1/1,12/31",
    ]  # fmt: skip
    lines = []
    for hour in range(HOURS):
        at = FIRST + timedelta(hours=hour)
        level, direct, diffuse, air, wind = values(hour)
        lines.append(
            f"{at.year},{at.month},{at.day},{at.hour + 1},60,?9,{air:.1f},5.0,60,101000,0,0,300,"
            f"{level},{direct},{diffuse},0,0,0,0,180,{wind},5,5,20,77777,9,999999999,15,0.1,0,88,0.2,0,1"
        )
    return "\n".join([*head, *lines, ""]).encode()


def tmy3() -> bytes:
    names = "Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),DNI (W/m^2),DHI (W/m^2),Dry-bulb (C),Wspd (m/s)"
    lines = [f'170300,"SAMSUN",TR,2.0,{LATITUDE},{LONGITUDE},{ALTITUDE:.0f}', names]
    for hour in range(HOURS):
        at = FIRST + timedelta(hours=hour)
        level, direct, diffuse, air, wind = values(hour)
        lines.append(f"{at:%m/%d/%Y},{at.hour + 1:02}:00,{level},{direct},{diffuse},{air:.1f},{wind}")
    return "\n".join([*lines, ""]).encode()


def pvgis_tmy(offset_h: float = 0.2) -> bytes:
    lines = [
        f"Latitude (decimal degrees): {LATITUDE}", f"Longitude (decimal degrees): {LONGITUDE}",
        f"Elevation (m): {ALTITUDE}", f"Irradiance Time Offset (h): {offset_h}", "month,year",
        *(f"{month},2015" for month in range(1, 13)),
        "time(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m,WD10m,SP",
    ]  # fmt: skip
    for hour in range(HOURS):
        at = FIRST + timedelta(hours=hour)
        level, direct, diffuse, air, wind = values((hour + 2) % HOURS)
        lines.append(f"{at:%Y%m%d:%H%M},{air:.2f},60,{level},{direct},{diffuse},300,{wind},180,101000")
    return "\r\n".join([*lines, "", "T2m: air", ""]).encode()


def pvgis_hourly(*, slope: int = 0, components: bool = True) -> bytes:
    """Two years, 2019 and leap year 2020, ten minutes past each hour."""
    parts = "Gb(i),Gd(i),Gr(i)" if components else "G(i)"
    lines = [
        f"Latitude (decimal degrees):\t{LATITUDE}", f"Longitude (decimal degrees):\t{LONGITUDE}",
        f"Elevation (m):\t{ALTITUDE}", "Radiation database:\tPVGIS-SARAH3", "", "",
        f"Slope: {slope} deg.", "Azimuth: 0 deg.", f"time,{parts},H_sun,T2m,WS10m,Int",
    ]  # fmt: skip
    first = datetime(2019, 1, 1, 0, 10, tzinfo=UTC)
    for hour in range(HOURS + HOURS + 24):
        at = first + timedelta(hours=hour)
        level, _, diffuse, air, wind = values((hour + 2) % HOURS)
        shown = f"{level - diffuse},{diffuse},0" if components else f"{level}"
        lines.append(f"{at:%Y%m%d:%H%M},{shown},0,{air:.2f},{wind},0")
    return "\r\n".join([*lines, "", "Gb(i): beam", ""]).encode()
