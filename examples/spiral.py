"""Fly the thesis' spiral under three laws in every engine, and draw the flights over each other.

Usage: spiral.py OUT.png
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Dict, Tuple

import numpy as np
import yaml
from matplotlib.figure import Figure

import quadcore as qc
from quadcore.report.colours import PALETTE
from quadcore.report.plots import dress, png

SETTINGS = yaml.safe_load((Path(__file__).parents[1] / "config" / "spiral.yaml").read_text())
LOST = 5.0  # m
COLOURS = {"gazebo11": PALETTE[0], "ode": PALETTE[4], "eigen": PALETTE[1]}
# ode and eigen lie upon each other.
WIDTHS = {"gazebo11": 1.6, "ode": 3.0, "eigen": 1.2}
STYLES = {"pid_thesis": ":", "pid": "--", "geometric": "-"}
TOLD = {
    "pid_thesis": "PID as printed",
    "pid": "PID with gains that fly",
    "geometric": "geometric",
}

Flights = Dict[Tuple[str, str], qc.Log]


def fly() -> Flights:
    """Fly; logs by law and engine, of a flight that ends early what was flown."""
    found = qc.evaluate(
        SETTINGS["controller"],
        SETTINGS["reference"],
        SETTINGS["engine"],
        duration=SETTINGS["duration"],
        xacro_args=SETTINGS["xacro"],
    )
    return {
        (row["controller"], row["engine"]): outcome.log
        for row, outcome in zip(found.table, found.outcomes)
    }


def away(log: qc.Log) -> np.ndarray:
    """Distance from the reference, m; NaN from when the vehicle is lost."""
    error = log.topics["error"]
    distance = np.linalg.norm([error[axis] for axis in "xyz"], axis=0)
    distance[np.maximum.accumulate(distance) > LOST] = np.nan
    return distance


def picture(logs: Flights) -> Figure:
    """Draw paths and distances."""
    figure = Figure(figsize=(10, 4.6), dpi=120)
    path = figure.add_axes((0.0, 0.05, 0.46, 0.95), projection="3d")
    apart = figure.add_axes((0.54, 0.13, 0.44, 0.68))
    # The widest first, so that it hides none.
    for (law, engine), log in sorted(logs.items(), key=lambda item: -WIDTHS[item[0][1]]):
        look = {"color": COLOURS[engine], "linewidth": WIDTHS[engine], "linestyle": STYLES[law]}
        distance = away(log)
        path.plot(*log.position[~np.isnan(distance)].T, **look)
        apart.semilogy(log.time, 1e3 * np.maximum(distance, 1e-6), **look)
    path.set_box_aspect((1, 1, 1.6), zoom=0.86)
    path.view_init(elev=18, azim=-60)
    for axis, ticks in zip("xyz", ([-2, 0, 2], [-2, 0, 2], [10, 20, 30, 40])):
        getattr(path, f"set_{axis}label")(f"{axis} (m)")
        getattr(path, f"set_{axis}ticks")(ticks)
    for engine, colour in COLOURS.items():
        apart.plot([], [], color=colour, label=engine)
    for law, style in STYLES.items():
        apart.plot([], [], color="0.3", linestyle=style, label=TOLD[law])
    apart.set_title("distance from the reference (mm)", loc="left", fontsize="medium")
    apart.set_xlabel("time (s)")
    dress(apart)
    figure.legend(
        *apart.get_legend_handles_labels(), loc="upper right", ncol=2, frameon=False,
        fontsize="small",
    )  # fmt: skip
    return figure


if __name__ == "__main__":
    Path(sys.argv[1]).write_bytes(png(picture(fly())))
    print(sys.argv[1])
