"""The numbers that C. Alexandru prints: Mathematics 12 (2024) 1034, doi:10.3390/math12071034, Section 4."""

DAY_NAMES = (
    "17 January", "15 February", "16 March", "15 April", "15 May", "10 June", "17 July", "16 August",
    "16 September", "16 October", "15 November", "10 December",
)  # fmt: skip
TABLE_4_DECLINATIONS_DEG = (
    -20.73, -12.95, -2.02, 9.78, 19.03, 23.09, 21.01, 13.12, 1.41, -10.33, -19.38, -23.12,
)  # fmt: skip
TABLE_4_MEANS_DEG = (
    -20.67, -13.00, -1.99, 9.86, 19.04, 23.11, 20.93, 12.97, 1.60, -10.21, -19.28, -23.12,
)  # fmt: skip
TABLE_4_GAINS_PERCENT = (
    34.19, 37.14, 38.32, 44.55, 51.64, 58.22, 51.26, 44.55, 38.96, 36.69, 35.06, 33.46,
)  # fmt: skip
MEAN_GAIN_PERCENT = 42.0
FIXED_WH, TABLE_3_WH, CONTINUOUS_WH = 1209.31, 1930.18, 2003.71
GAIN_PERCENT = 58.66
SUNRISE_H, SUNSET_H = 4.26, 19.74
DIURNAL_MM, ELEVATION_MM = (650.0, 950.0), (550.0, 750.0)
ELEVATION_TILTS_DEG = (22.05, 68.95)
SOLSTICE_STROKE_MM = 0.0
