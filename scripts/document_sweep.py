#!/usr/bin/env python3
"""Draw the picture of docs/sweep.md into docs/images: ``scripts/document`` runs it."""

from __future__ import annotations

import tempfile
from pathlib import Path

from images import save

from quadcore.sweeps.design import Design
from quadcore.sweeps.pictures import draw
from quadcore.sweeps.plan import Plan
from quadcore.sweeps.sensitivity import sensitivities
from quadcore.sweeps.sweep import conduct
from quadcore.sweeps.table import table

AXES = {
    "frame.mass": "uniform:0.9:1.1",
    "drone_plugin.rotorThrustCoeff": "normal:1.1487e-5:3e-7",
    "drone_plugin.inducedDragCoeff": "uniform:0:0.03",
    "motorpid_plugin.kp": "uniform:2.5e-4:7.5e-4",
}


def main() -> None:
    """Fly a law that is wrong about its vehicle, and draw what that costs."""
    design = Design(AXES, None, "sobol", 512)
    plan = Plan(design, "geometric", "circle:rate=1.5", options={"xacro_args": {"sim_slow": 1}})
    with tempfile.TemporaryDirectory() as folder:
        columns = table(conduct(plan, Path(folder)))
    pictures = draw(plan, columns, sensitivities(plan, columns), "rms_position")
    save("sweep_parallel", pictures["parallel"])


if __name__ == "__main__":
    main()
