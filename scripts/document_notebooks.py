#!/usr/bin/env python3
"""Run the notebooks and write their results to docs/notebooks.md: ``scripts/document`` runs it."""

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
    """Run a notebook from the first cell to the last; returns its variables."""
    return runpy.run_path(str(NOTEBOOKS / f"{name}.py"), run_name="__main__")


def fitted(names: Dict[str, Any]) -> Iterator[Any]:
    """Tabulate the identified parameters."""
    found, true = names["found"], names["TRUE"]
    for name, value in found.values.items():
        deviation = figures(found.identified.deviations[name])
        found_value = f"{figures(value, 6)} +- {deviation} {found.units[name]}"
        yield f"`{name}`", figures(found.start[name], 5), found_value, figures(true[name], 5)


def main() -> None:
    """Run all three notebooks."""
    matplotlib.use("agg")
    for name in ("why_gazebo_misled", "tuning_a_controller"):
        save(f"notebook_{name}", png(run(name)["figure"]))
    heading = ("parameter", "model", "found", "true")
    put("notebooks.md", "identified", heading, fitted(run("identifying_a_vehicle")))


if __name__ == "__main__":
    main()
