"""Write the figures of the docs, docs/images/NAME.png."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
COLOURS = 64  # enough for a screen, at half the size


def save(name: str, png: bytes) -> None:
    """Write a figure."""
    (IMAGES / f"{name}.png").write_bytes(png)
    print(f"docs/images/{name}.png")


def save_in_few_colours(name: str, picture: Image.Image) -> None:
    """Write a figure with large uniform areas in few colours."""
    few = picture.convert("RGB").quantize(
        COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE
    )  # this method keeps the colours of thin lines
    data = io.BytesIO()
    few.save(data, "PNG", optimize=True)
    save(name, data.getvalue())
