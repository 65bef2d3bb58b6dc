"""Simulate the spiral of the thesis with two controllers in every engine; write logs and a plot.

Usage: spiral.py [FOLDER]
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
COLOURS = {"gazebo11": PALETTE[0], "ode": PALETTE[4], "eigen": PALETTE[1]}
# Curves that coincide stay visible.
WIDTHS = {"gazebo11": 1.6, "ode": 3.0, "eigen": 1.2}
STYLES = {"pid": "--", "geometric": "-"}

Flights = Dict[Tuple[str, str], qc.Log]


def fly() -> Flights:
    """Simulate all flights; the logs, by controller and engine."""
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


def tracking_error(log: qc.Log) -> np.ndarray:
    """Return the distance from the reference in m."""
    error = log.topics["error"]
    return np.linalg.norm([error[axis] for axis in "xyz"], axis=0)


def picture(logs: Flights) -> Figure:
    """Draw the paths and the tracking errors."""
    figure = Figure(figsize=(10, 4.6), dpi=120)
    path = figure.add_axes((0.0, 0.05, 0.46, 0.95), projection="3d")
    errors = figure.add_axes((0.54, 0.13, 0.44, 0.68))
    # The widest first, so that it hides none.
    for (controller, engine), log in sorted(logs.items(), key=lambda item: -WIDTHS[item[0][1]]):
        look = {
            "color": COLOURS[engine],
            "linewidth": WIDTHS[engine],
            "linestyle": STYLES[controller],
        }
        path.plot(*log.position.T, **look)
        errors.semilogy(log.time, 1e3 * np.maximum(tracking_error(log), 1e-6), **look)
    path.set_box_aspect((1, 1, 1.6), zoom=0.86)
    path.view_init(elev=18, azim=-60)
    for axis, ticks in zip("xyz", ([-2, 0, 2], [-2, 0, 2], [10, 20, 30, 40])):
        getattr(path, f"set_{axis}label")(f"{axis} (m)")
        getattr(path, f"set_{axis}ticks")(ticks)
    for engine, colour in COLOURS.items():
        errors.plot([], [], color=colour, label=engine)
    for controller, style in STYLES.items():
        errors.plot([], [], color="0.3", linestyle=style, label=controller)
    errors.set_title("tracking error (mm)", loc="left", fontsize="medium")
    errors.set_xlabel("time (s)")
    dress(errors)
    figure.legend(
        *errors.get_legend_handles_labels(), loc="upper right", ncol=2, frameon=False,
        fontsize="small",
    )  # fmt: skip
    return figure


def write(logs: Flights, folder: Path) -> None:
    """Write the plot and a log for each flight."""
    (folder / "logs").mkdir(parents=True, exist_ok=True)
    for (controller, engine), log in logs.items():
        log.to_csv(folder / "logs" / f"{controller}_{engine}.csv")
    (folder / "engines.png").write_bytes(png(picture(logs)))
    print(f"written {folder / 'engines.png'} and {len(logs)} logs in {folder / 'logs'}")


if __name__ == "__main__":
    write(fly(), Path(sys.argv[1] if len(sys.argv) > 1 else "out"))
