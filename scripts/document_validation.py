#!/usr/bin/env python3
"""Draw the pictures of docs/validation.md into docs/images: ``scripts/document`` runs it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from quadcore.plots import PALETTE, dress, png, titled
from quadcore.validation import Experiment, conduct
from quadcore.validation.figures import pictures

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
FROM_THE_COMMAND = {"position": "position_all", "error": "error_all", "chain": "chain_all"}


def draw_gains() -> bytes:
    """Draw how the outer loop of table 6.2 corrects an error on an ideal double integrator."""
    figure = titled("Outer loop of table 6.2 in x and y, ideal plant: error from 2 m", 7, 2.8, 100)
    axes = figure.add_axes((0.09, 0.17, 0.89, 0.68))
    dress(axes)
    time = np.linspace(0, 20, 500)
    for Kd, colour, label in (
        (0.125, PALETTE[1], "$K_D$ 0.125, as published"),
        (2.5, PALETTE[0], "$K_D$ 2.5"),
    ):
        roots = np.roots([1, Kd, 2.4, 0.8])
        # e = 2 m, at rest, integral empty: e, edot, eddot = -Kp e at t = 0.
        shares = np.linalg.solve(np.vander(roots, 3, increasing=True).T, [2, 0, -2.4 * 2])
        error = (shares * np.exp(np.outer(time, roots))).sum(axis=1).real
        axes.plot(time, error, color=colour, label=label)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("error (m)")
    axes.legend(loc="upper left", frameon=False, ncol=2, fontsize="small")
    axes.set_ylim(-14, 18)
    return png(figure)


def main() -> None:
    """Fly the experiment as ``quadcore validate`` does, and draw."""
    drawn = {"gains": draw_gains()}
    wanted = pictures(conduct(Experiment.of()))
    for name, picture in {**FROM_THE_COMMAND, "commands": "commands", "damping": "damping"}.items():
        function, arguments = wanted[picture]
        drawn[name] = function(*arguments)
    IMAGES.mkdir(parents=True, exist_ok=True)
    for name, data in drawn.items():
        (IMAGES / f"validation_{name}.png").write_bytes(data)
        print(f"docs/images/validation_{name}.png")


if __name__ == "__main__":
    main()
