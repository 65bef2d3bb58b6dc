#!/usr/bin/env python3
"""Draw the figure of docs/sweep.md and of its tutorial into docs/images.

``scripts/document`` runs it.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from images import save

from quadcore.studies.design import Design
from quadcore.studies.figures import draw_figures
from quadcore.studies.options import SweepOptions
from quadcore.studies.sweep.plan import Plan
from quadcore.studies.sweep.plots import list_figures
from quadcore.studies.sweep.sensitivity import compute_sensitivities
from quadcore.studies.sweep.sweep import fly_plan
from quadcore.studies.sweep.table import make_table

# The axes of the tutorial: the controller's modelled value over the true value.
AXES = {
    "controller.believed_mass": "normal:1:0.05",
    "controller.believed_thrust": "uniform:0.95:1.05",
}


def main() -> None:
    """Run a sweep of a controller with model errors, and draw the tracking error."""
    design = Design(AXES, None, "latin", 500)
    options = SweepOptions(duration=5.0, xacro_args={"sim_slow": 1})
    plan = Plan(design, "geometric", "circle", ["eigen"], ["quadrotor"], options)
    with tempfile.TemporaryDirectory() as folder:
        columns = make_table(fly_plan(plan, Path(folder)))
    figures = list_figures(plan, columns, compute_sensitivities(plan, columns), "rms_position")
    pictures = draw_figures({"surface": figures["surface"]})
    save("sweep_surface", pictures["surface"].files["png"])


if __name__ == "__main__":
    main()
