#!/usr/bin/env python3
"""Draw the pictures of docs/evaluate.md into docs/images: ``scripts/document`` runs it."""

from __future__ import annotations

from pathlib import Path

import yaml
from images import save

import quadcore as qc
from quadcore.evaluation.pictures import draw

LAWS = ["pd", "pd_compensated", "pid", "geometric", "indi", "lqr"]
SPIRAL = yaml.safe_load((Path(__file__).parents[1] / "config" / "spiral.yaml").read_text())


def main() -> None:
    """Fly 20 seeds of each law and draw them."""
    found = qc.evaluate(LAWS, "circle", seeds=20, xacro_args=SPIRAL["xacro"])
    pictures = draw(found)
    for name, of in (("evaluate_errors", "errors_1"), ("evaluate_seeds", "seeds")):
        save(name, pictures[of])


if __name__ == "__main__":
    main()
