"""Write tables of measured figures to the docs, each between marks with its name.

    <!-- measured: NAME -->
    | ... |
    <!-- end -->

The scripts that measure the figures write them, so no figure is copied by hand.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Iterable, Sequence

from markdown_table import table

DOCS = Path(__file__).resolve().parents[1] / "docs"


def put(page: str, name: str, heading: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table between its marks in docs/PAGE."""
    path = DOCS / page
    laid_out = table(heading, rows)
    place = re.compile(rf"(<!-- measured: {name} -->\n).*?(<!-- end -->)", re.DOTALL)
    text, count = place.subn(lambda found: found[1] + laid_out + found[2], path.read_text())
    if count != 1:
        raise SystemExit(f"docs/{page}: {count} places for the table '{name}'. Write one.")
    path.write_text(text)
    print(f"docs/{page}: {name}")


def figures(value: float, digits: int = 2) -> str:
    """Format a number with this many digits, without leading zeros of the exponent."""
    text = f"{value:.{digits}g}"
    return re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", text)
