"""Draws the icons of the installed panel from the shapes of icon.svg: `python static/img/icons.py`."""

from pathlib import Path

from PIL import Image, ImageDraw

HERE = Path(__file__).parent
BLUE, WHITE = "#0b4f8a", "#ffffff"
PANEL = ((6.0, 15.0), (19.0, 6.0), (26.0, 13.0), (13.0, 22.0))
CELLS = (((10.3, 12.0), (17.3, 19.2)), ((14.7, 9.0), (21.7, 16.0)), ((9.5, 18.5), (22.5, 9.5)))
MAST = (((16.0, 20.0), (16.0, 27.0)), ((12.0, 27.0), (20.0, 27.0)))
UNITS = 32.0
FINER = 4


def icon(size: int, *, is_maskable: bool) -> Image.Image:
    """Return the icon; a maskable one fills its square, its shapes within the middle 80 percent."""
    wide = size * FINER
    shrink = 0.72 if is_maskable else 1.0
    scale = wide / UNITS * shrink
    edge = wide * (1 - shrink) / 2
    drawn = Image.new("RGBA", (wide, wide), BLUE if is_maskable else "#00000000")
    pen = ImageDraw.Draw(drawn)

    def at(*points: tuple[float, float]) -> list[tuple[float, float]]:
        return [(x * scale + edge, y * scale + edge) for x, y in points]

    if not is_maskable:
        pen.rounded_rectangle((0, 0, wide - 1, wide - 1), radius=wide * 6 / UNITS, fill=BLUE)
    for line in MAST:
        pen.line(at(*line), fill=WHITE, width=round(2.5 * scale))
    pen.polygon(at(*PANEL), fill=WHITE)
    for line in CELLS:
        pen.line(at(*line), fill=BLUE, width=round(1.2 * scale))
    return drawn.resize((size, size), Image.Resampling.LANCZOS)


def main() -> None:
    """Write the three icons beside this file."""
    for name, size, is_maskable in (
        ("icon-192.png", 192, False),
        ("icon-512.png", 512, False),
        ("icon-maskable-512.png", 512, True),
    ):
        icon(size, is_maskable=is_maskable).save(HERE / name, optimize=True)


if __name__ == "__main__":
    main()
