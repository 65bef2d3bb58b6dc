#!/usr/bin/env python3
"""Run the notebooks, and show in docs/notebooks.md what they find: ``scripts/document`` runs it."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any, Dict, Iterator

import matplotlib
from images import save
from measured import figures, put

from quadcore.report.plots import png

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"


def run(name: str) -> Dict[str, Any]:
    """Run a notebook from the first cell to the last; what it has defined."""
    return runpy.run_path(str(NOTEBOOKS / f"{name}.py"), run_name="__main__")


def fitted(names: Dict[str, Any]) -> Iterator[Any]:
    """Tabulate what the flight told of the vehicle."""
    found, true = names["found"], names["TRUE"]
    for name, value in found.values.items():
        deviation = figures(found.identified.deviations[name])
        told = f"{figures(value, 6)} +- {deviation} {found.units[name]}"
        yield f"`{name}`", figures(found.start[name], 5), told, figures(true[name], 5)


def main() -> None:
    """Run all three."""
    matplotlib.use("agg")
    for name in ("why_gazebo_misled", "tuning_a_controller"):
        save(f"notebook_{name}", png(run(name)["figure"]))
    heading = ("parameter", "model", "found", "true")
    put("notebooks.md", "identified", heading, fitted(run("identifying_a_vehicle")))


if __name__ == "__main__":
    main()
