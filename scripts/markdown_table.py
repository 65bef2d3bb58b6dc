"""Markdown tables of the docs."""

from __future__ import annotations

from typing import Iterable, Sequence


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Lay out a Markdown table."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join("| " + " | ".join(map(_cell, line)) + " |\n" for line in lines)


def _cell(content: object) -> str:
    return str(content).replace("|", "\\|")
