#!/usr/bin/env python3
"""Draw the figures of docs/evaluate.md into docs/images: ``scripts/document`` runs it."""

from __future__ import annotations

from images import save
from noise import THESIS

import quadcore as qc
from quadcore.studies.evaluate.plots import list_figures
from quadcore.studies.figures import draw_figures

CONTROLLERS = ["pd", "pd_compensated", "pid", "geometric", "indi", "lqr"]


def main() -> None:
    """Simulate and plot 20 seeds of each controller."""
    found = qc.evaluate(
        CONTROLLERS, "circle", seeds=20, parameters=THESIS, xacro_args={"sim_slow": 1}
    )
    pictures = draw_figures(list_figures(found))
    for name, of in (("evaluate_errors", "errors_1"), ("evaluate_seeds", "seeds")):
        save(name, pictures[of].files["png"])


if __name__ == "__main__":
    main()
