"""The pictures of the docs, docs/images/NAME.png."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
COLOURS = 64  # enough for a screen, and half the size


def save(name: str, png: bytes) -> None:
    """Write a picture."""
    (IMAGES / f"{name}.png").write_bytes(png)
    print(f"docs/images/{name}.png")


def save_in_few_colours(name: str, picture: Image.Image) -> None:
    """Write a picture that has large even areas."""
    few = picture.convert("RGB").quantize(
        COLOURS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE
    )  # the method that leaves colours of thin lines as they are
    data = io.BytesIO()
    few.save(data, "PNG", optimize=True)
    save(name, data.getvalue())
